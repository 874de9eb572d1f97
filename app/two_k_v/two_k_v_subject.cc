#include "app/two_k_v/two_k_v_subject.h"

#include <fmt/format.h>

#include <limits>
#include <numbers>
#include <numeric>

#include "app/content_id.h"
#include "app/pipeline.h"
#include "app/study/planetary_subject.h"
#include "app/study/study_cases.h"
#include "core/log.h"

namespace annulus::app {

namespace {

constexpr std::size_t told_frequencies = 6;

/// Over a crank turn: as no mesh has a whole number of cycles between two of them, each meets as many phases.
int stiffness_positions(const dynamics::TwoKVStage& stage) {
  int count = 37;
  while (std::gcd(count, stage.planet_teeth) != 1 || std::gcd(count, stage.arc_teeth) != 1) ++count;
  return count;
}
constexpr double arc_seconds = 180 * 3600 / std::numbers::pi;  // per radian

/// Both ways a stage with tables is taken, and how it is simulated.
struct TwoKVPoint {
  dynamics::TwoKVStage at_nominal, moving;
  dynamics::SimulationOptions simulation;
  double arc_clearance = 0;
};

StudyPoint two_k_v_point(const TwoKVPoint& p, bool quick) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  StudyPoint point;
  auto& values = point.values;
  std::vector<double> frequencies;
  for (const auto& mode : dynamics::modes(p.at_nominal).modes)
    if (mode.frequency > 0) frequencies.push_back(mode.frequency);
  for (std::size_t i = 0; i < told_frequencies; ++i)
    values.push_back(i < frequencies.size() ? frequencies[i] : unknown);
  const auto torsion = dynamics::torsional_stiffness(p.at_nominal, stiffness_positions(p.at_nominal));
  const auto lost = lost_motion(p.at_nominal, torsion.mean(), p.arc_clearance);
  constexpr double rounding = 1e-10;  // of the condensation
  values.insert(values.end(),
                {torsion.mean(), torsion.ripple() > rounding ? torsion.ripple() : 0, lost.wind_up, lost.total()});
  if (quick) {
    values.push_back(1);  // nothing was integrated
    values.insert(values.end(), 7, unknown);
    return point;
  }
  auto simulation = p.simulation;
  simulation.keep_series = false;
  const auto m = motion_of(p.moving, dynamics::simulate(p.moving, simulation));
  // Nothing is excited, so what is left is rounding.
  const bool still = constant_stiffness(p.moving) && m.steady && !m.output_moves();
  values.insert(values.end(),
                {m.steady ? 1.0 : 0.0, still ? 0 : m.error_peak_to_peak.value, still ? 0 : m.static_error_peak_to_peak,
                 still ? 1 : m.dynamic_factor(false), still ? 1 : m.dynamic_factor(true), m.contact_loss(false),
                 m.contact_loss(true), m.largest_bearing_force()});
  return point;
}

}  // namespace

std::vector<StudyFigure> two_k_v_figures() {
  std::vector<StudyFigure> list;
  for (std::size_t i = 1; i <= told_frequencies; ++i)
    list.push_back({.column = fmt::format("frequency_{}_Hz", i),
                    .title = fmt::format("Natural frequency {}", i),
                    .label = "Hz",
                    .plotted = i == 1,
                    .spread = i == 1,
                    .ordering = i == 1});
  list.push_back({.column = "torsional_stiffness_Nm_per_rad",
                  .title = "Torsional stiffness from the output",
                  .label = "kN m/rad",
                  .scale = 1e-3,
                  .plotted = true,
                  .spread = true,
                  .ordering = true});
  list.push_back({.column = "torsional_stiffness_ripple",
                  .title = "Range of the torsional stiffness over a crank turn",
                  .label = "% of the mean",
                  .scale = 100,
                  .spread = true});
  list.push_back({.column = "wind_up_rad",
                  .title = "Wind-up of the output under load",
                  .label = "arc seconds",
                  .scale = arc_seconds,
                  .spread = true});
  list.push_back({.column = "lost_motion_rad",
                  .title = "Lost motion of the output",
                  .label = "arc seconds",
                  .scale = arc_seconds,
                  .spread = true});
  list.push_back({.column = "steady", .title = "Periodic"});
  list.push_back({.column = "output_error_peak_to_peak_rad",
                  .title = "Error of the output",
                  .label = "peak to peak, arc seconds",
                  .scale = arc_seconds,
                  .quick = false,
                  .plotted = true,
                  .ordering = true,
                  .with = "output_error_quasi_static_rad"});
  list.push_back({.column = "output_error_quasi_static_rad",
                  .title = "Error of the output, quasi-static",
                  .label = "peak to peak, arc seconds",
                  .scale = arc_seconds,
                  .quick = false});
  for (const std::string mesh : {"sun_planet", "arc_pins"})
    list.push_back(
        {.column = mesh + "_dynamic_factor",
         .title = mesh == "arc_pins" ? "Dynamic factor of the arc meshes" : "Dynamic factor of the sun meshes",
         .label = "largest F / mean mesh force",
         .quick = false,
         .plotted = true});
  for (const std::string mesh : {"sun_planet", "arc_pins"})
    list.push_back(
        {.column = mesh + "_contact_loss",
         .title = mesh == "arc_pins" ? "Time without contact, arc meshes" : "Time without contact, sun meshes",
         .label = "worst, %",
         .scale = 100,
         .quick = false,
         .plotted = true});
  list.push_back({.column = "arc_bearing_force_N",
                  .title = "Largest force of an eccentric's bearing",
                  .label = "N",
                  .quick = false});
  return list;
}

NominalFigures TwoKVSubject::nominal(std::size_t) const {
  NominalFigures figures;
  if (motion_) figures["output_error_peak_to_peak_rad"] = motion_->error_peak_to_peak;
  return figures;
}

bool TwoKVSubject::prepare(const std::vector<Override>& overrides, const std::string& where,
                           const std::string& folder) const {
  const auto scene = with_overrides(scene_, overrides);
  const auto model = two_k_v_sun_model(scene);
  if (table_serves(nominal_.sun.model, model, two_k_v_kinematics(scene).mean_sun_mesh_force())) return false;
  const auto inside = options_in(folder);
  if (load(model, inside.out)) {
    count_reuse(inside, study_meshes, 1, 0);
    return true;
  }
  log::info(where + ":");
  (void)computed_stiffness(model, {""}, inside);
  return true;
}

ChangedModel TwoKVSubject::model(const std::vector<Override>& overrides, const std::string& where, std::size_t,
                                 const std::string& folder, bool with_id) const {
  try {
    const auto scene = with_overrides(scene_, overrides);
    const double force = two_k_v_kinematics(scene).mean_sun_mesh_force();
    const auto sun_model = two_k_v_sun_model(scene);
    TwoKVTables tables{nominal_.sun, arc_pins_result(scene)};
    if (!table_serves(nominal_.sun.model, sun_model, force)) {
      if (folder.empty())
        throw InputError(
            fmt::format("the {} is not tabulated for a mean mesh force of {} N", sun_model.label(), to_text(force, 5)));
      auto kept = load(sun_model, options_in(folder).out);
      if (!kept) throw InternalError("internal error: a changed scene without its stiffness table");
      tables.sun = std::move(*kept);
    }
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
