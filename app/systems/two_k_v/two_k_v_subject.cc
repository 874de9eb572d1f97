#include "app/systems/two_k_v/two_k_v_subject.h"

#include "app/content_id.h"
#include "app/pipeline.h"
#include "app/study/study_cases.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

/// Both ways a stage with tables is taken, and how it is simulated.
struct TwoKVPoint {
  dynamics::TwoKVStage at_nominal, moving;
  dynamics::SimulationOptions simulation;
  double arc_clearance = 0;
};

StudyPoint two_k_v_point(const TwoKVPoint& p, bool quick) {
  auto figures = dynamics::static_figures(p.at_nominal, p.arc_clearance);
  if (quick) {
    figures.set("steady", 1);  // nothing was integrated
  } else {
    auto simulation = p.simulation;
    simulation.keep_series = false;
    figures.add(dynamics::figures(p.moving, dynamics::simulate(p.moving, simulation)));
  }
  return {.figures = {dynamics::two_k_v_figures(), figures}};
}

}  // namespace

FigureSet TwoKVSubject::nominal(std::size_t) const {
  FigureSet figures;
  if (motion_) figures.set("output_error_peak_to_peak_rad", motion_->error_peak_to_peak);
  return figures;
}

bool TwoKVSubject::prepare(const std::vector<Override>& overrides, const std::string& where,
                           const std::string& folder) const {
  const auto scene = with_overrides(scene_, overrides);
  return prepare_mesh(nominal_.sun.model, two_k_v_sun_model(scene), two_k_v_kinematics(scene).mean_sun_mesh_force(),
                      where, folder);
}

ChangedModel TwoKVSubject::model(const std::vector<Override>& overrides, const std::string& where, std::size_t,
                                 const std::string& folder, bool with_id) const {
  try {
    const auto scene = with_overrides(scene_, overrides);
    TwoKVTables tables{nominal_.sun, arc_pins_result(scene)};
    if (auto sun = changed_mesh(nominal_.sun.model, two_k_v_sun_model(scene),
                                two_k_v_kinematics(scene).mean_sun_mesh_force(), folder))
      tables.sun = std::move(*sun);
    TwoKVPoint point{.at_nominal = make_two_k_v(scene, tables, dynamics::LoadDependence::nominal),
                     .moving = make_two_k_v(scene, tables, scene.dynamics->load_dependence),
                     .simulation = {},
                     .arc_clearance = scene.arc_gear.clearance};
    point.moving.check();
    point.simulation = two_k_v_simulation(scene, point.moving);
    std::string id;
    if (with_id)
      id = ContentId()
               .add("two_k_v", two_k_v_id(point.moving, point.simulation, tables))
               .add("arc_clearance", point.arc_clearance)
               .id();
    return {id, [point = std::move(point)](bool quick) { return two_k_v_point(point, quick); }};
  } catch (const InputError&) {
    rethrow_at(scene_, where);
  }
}

}  // namespace annulus::app
