#include "app/systems/helical_pair/pair_table_errors.h"

#include <utility>

#include "dynamics/error_propagation/error_propagation.h"

namespace annulus::app {

namespace {

dynamics::Evaluation evaluation_of(const dynamics::HelicalPair& pair, const dynamics::PairResponse& response) {
  dynamics::Evaluation evaluation{.figures = dynamics::figures(response), .outcome = response};
  evaluation.figures.add(dynamics::frequency_figures(pair));
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
                                    {"transmission_error_max_m", &te.largest},
                                    {"transmission_error_peak_to_peak_m", &te.peak_to_peak},
                                    {"transmission_error_static_max_m", &still.largest},
                                    {"transmission_error_static_peak_to_peak_m", &still.peak_to_peak},
                                    {"relative_motion_max_m", &relative.largest},
                                    {"relative_motion_peak_to_peak_m", &relative.peak_to_peak}})
    figure->error = figures.figure(key).error;
}

}  // namespace

FigureSet carried_pair_errors(const PairRunResult& result, const dynamics::SimulationOptions& options,
                              dynamics::PairResponse& response) {
  const auto comparison = dynamics::comparison_options(response, options);
  dynamics::TabulatedModel model{.meshes = {},
                                 .evaluate = {},
                                 .seeks_steady_state = comparison.seeks_steady_state,
                                 .nominal_alike = comparison.nominal_alike};
  if (result.mesh.table)
    model.meshes.push_back({"mesh", *result.mesh.table,
                            result.mesh.computed ? result.mesh.computed->mean_stiffness().parts : ErrorParts{}});
  model.evaluate = [&](const std::vector<StiffnessTable>& tables) {
    PairMesh mesh = result.mesh;
    mesh.table = tables.front();
    auto pair = *result.pair;
    pair.mesh = pair_excitation(result.scene, result.geometry, mesh);
    return evaluation_of(pair, dynamics::evaluate_pair(pair, comparison.simulation));
  };
  auto figures = propagate_errors(evaluation_of(*result.pair, response), model);
  set_errors(figures, response);
  return figures;
}

}  // namespace annulus::app
