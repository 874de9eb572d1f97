#include "app/systems/helical_pair/pair_lumped_model.h"

#include <cmath>
#include <utility>

#include "app/model/dynamics_members.h"
#include "app/model/excitation.h"
#include "app/model/table_errors.h"
#include "app/results/cached_value.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/shared/friction.h"
#include "app/systems/shared/mesh_names.h"
#include "app/systems/shared/space_members.h"
#include "dynamics/friction/friction_losses.h"

namespace annulus {

ANNULUS_MEMBERS(dynamics::ErrorWave, amount, phase);
ANNULUS_MEMBERS(dynamics::PairGear, teeth, mass, inertia, radius, bearing_transverse, bearing_axial, error,
                damping_ratio);
template <>
struct Members<dynamics::PairSpace> {
  template <class Space>
  static auto of(Space& s) {
    return std::tie(static_cast<dynamics::SpaceSupports&>(s), s.working_radius_pinion, s.working_radius_wheel,
                    s.tilt_inertia_pinion, s.tilt_inertia_wheel, s.mass_place_pinion, s.mass_place_wheel, s.face);
  }
};
ANNULUS_MEMBERS(dynamics::HelicalPair, pinion, wheel, base_helix_angle, working_angle, mesh, mesh_error, half_backlash,
                mesh_damping, bearing_damping, structural_damping, damping_without_contact, friction, film,
                pinion_speed, pinion_torque, space, rotors);

}  // namespace annulus

namespace annulus::app {

namespace {

/// How responses of studies are found; enters the identity of cached results.
constexpr const char* pair_point_method = "harmonic balance, time integration where needed; 2";

dynamics::Evaluation evaluation_of(const dynamics::HelicalPair& pair, const dynamics::PairResponse& response) {
  dynamics::Evaluation evaluation{.figures = dynamics::figures(response),
                                  .outcome = static_cast<const dynamics::SteadyOutcome&>(response)};
  evaluation.figures.add(dynamics::frequency_figures(pair));
  dynamics::add_each_shaft(evaluation.figures, response.shafts);
  return evaluation;
}

/// The totals back into the response that the results were read from.
void set_errors(const FigureSet& figures, dynamics::PairResponse& r) {
  auto &te = r.dynamic.transmission_error, &relative = r.dynamic.relative, &still = r.quasi_static.transmission_error;
  const bool forward = r.static_force >= 0;
  for (const auto& [key, figure] : {std::pair{"acceleration_max_m_per_s2", &r.acceleration.tooth},
                                    {"acceleration_line_of_action_m_per_s2", &r.acceleration.line_of_action},
                                    {"acceleration_axial_m_per_s2", &r.acceleration.axial},
                                    {"acceleration_rotation_m_per_s2", &r.acceleration.rotation},
                                    {"mesh_force_max_N", forward ? &r.force_max : &r.force_min},
                                    {"mesh_force_min_N", forward ? &r.force_min : &r.force_max},
                                    {"dynamic_factor", &r.dynamic_factor},
                                    {"peak_factor", &r.peak_factor},
                                    {"transmission_error_mean_m", &te.mean},
                                    {"transmission_error_max_m", &te.largest},
                                    {"transmission_error_peak_to_peak_m", &te.peak_to_peak},
                                    {"transmission_error_static_mean_m", &still.mean},
                                    {"transmission_error_static_max_m", &still.largest},
                                    {"transmission_error_static_peak_to_peak_m", &still.peak_to_peak},
                                    {"relative_motion_mean_m", &relative.mean},
                                    {"relative_motion_max_m", &relative.largest},
                                    {"relative_motion_peak_to_peak_m", &relative.peak_to_peak}})
    figure->error = figures.figure(key).error;
  dynamics::set_errors(r.shafts, figures);
}

}  // namespace

std::string LumpedPair::id(const dynamics::SimulationOptions& options) const {
  return identity_of(pair, options, table_behind(pair.mesh, mesh.table));
}

LumpedPair lumped_pair(const Scene& scene, const PairGeometry& geometry, const MeshResult& mesh, double mesh_error) {
  return {
      scene, geometry, stiffness_alone(mesh), mesh_error,
      make_pair(scene, geometry, pair_excitation(scene, geometry, mesh.table), mesh_error, {mesh.face, mesh.shares})};
}

FigureSet pair_losses(const Scene& scene, const PairGeometry& geometry, const PairShares& shares) {
  FigureSet figures;
  if (!has_friction(scene)) return figures;
  dynamics::add_losses(figures, {mesh_losses(scene, pinion_wheel, rolling_mesh(scene, geometry), shares, 1)},
                       std::abs(helical_pair(scene).stage.pinion_torque) * helical_pair(scene).stage.pinion_speed);
  return figures;
}

const std::vector<FigureSpec>& pair_study_figures() {
  static const auto list = [] {
    auto specs = dynamics::pair_figures();
    specs.push_back(dynamics::efficiency_figure());
    return specs;
  }();
  return list;
}

std::unique_ptr<LumpedModel> pair_lumped_model(const LumpedPair& lumped) {
  const auto efficiency = dynamics::efficiency_alone(pair_losses(lumped.scene, lumped.geometry, lumped.mesh.shares));
  auto simulation = pair_simulation(lumped.scene);
  simulation.confirmation = dynamics::Confirmation::where_needed;
  simulation.keep_series = false;
  return std::make_unique<LumpedModel>(
      identity_of(lumped.id(simulation), std::string(pair_point_method)),
      [pair = lumped.pair, simulation, efficiency](Answer wanted) -> StudyPoint {
        auto figures = dynamics::figures(dynamics::evaluate_pair(pair, simulation));
        if (wanted == Answer::all) figures.add(dynamics::frequency_figures(pair));
        figures.add(efficiency);
        return {.figures = {pair_study_figures(), figures}};
      },
      LumpedModel::Abilities{
          {},
          [pair = lumped.pair, simulation,
           efficiency](const dynamics::SystemState* start) -> LumpedModel::FollowedPoint {
            const auto response = dynamics::evaluate_pair(pair, dynamics::followed_from(simulation, start));
            auto figures = dynamics::figures(response);
            figures.add(dynamics::frequency_figures(pair));
            figures.add(efficiency);
            return {{.figures = {pair_study_figures(), figures}}, response.end};
          },
          [pair = lumped.pair] { return dynamics::lumped_case(pair); },
          [pair = lumped.pair](const dynamics::TimeSeries& series) { return dynamics::space_motion(pair, series); }});
}

FigureSet propagated_pair_errors(const LumpedPair& lumped, const dynamics::SimulationOptions& options,
                                 dynamics::PairResponse& response) {
  const auto way = dynamics::comparison_options(response, options);
  auto figures = with_table_errors(
      evaluation_of(lumped.pair, response), {&lumped.mesh},
      [&](const std::vector<const MeshResult*>& changed) {
        auto pair = lumped.pair;
        pair.mesh = pair_excitation(lumped.scene, lumped.geometry, changed.front()->table);
        return evaluation_of(pair, dynamics::evaluate_pair(pair, way.simulation));
      },
      way);
  // The moments of solid gears while these tilt.
  if (const auto& space = lumped.pair.space; space && space->face.shape && space->face.shape->tilted) {
    auto tilted = lumped.pair;
    tilted.space->face.shape = space->face.shape->tilted;
    const auto on = [&](const dynamics::HelicalPair& pair) {
      return evaluation_of(pair, dynamics::evaluate_pair(pair, way.simulation)).figures;
    };
    add_change(figures, on(lumped.pair), on(tilted));
  }
  set_errors(figures, response);
  return figures;
}

}  // namespace annulus::app
