#include "app/model/excitation.h"

#include <algorithm>

#include "app/plan/accuracy_choice.h"

namespace annulus::app {

dynamics::MeshExcitation excitation_of(const MeshInput& input, const MeshResult& mesh, double nominal_load,
                                       dynamics::LoadDependence dependence, std::optional<double> back_flank_phase) {
  switch (input.stiffness) {
    case StiffnessShape::constant:
      return dynamics::ConstantStiffness{*input.mean};
    case StiffnessShape::harmonic:
      return dynamics::HarmonicStiffness{*input.mean, *input.ripple, input.phase.value_or(0)};
    case StiffnessShape::rectangular:
      return dynamics::RectangularStiffness{*input.mean, *input.ripple, *input.duty, input.phase.value_or(0)};
    case StiffnessShape::computed:
    case StiffnessShape::table:
    case StiffnessShape::iso_6336:  // of pairs alone
    case StiffnessShape::closed_form:
      break;
  }
  // A single load does not determine the stiffness at others.
  if (mesh.table.loads().size() == 1) dependence = dynamics::LoadDependence::nominal;
  auto stiffness = dynamics::table_stiffness(mesh.table, nominal_load, 0, dependence);
  stiffness.back_flank_phase = back_flank_phase;
  return stiffness;
}

std::optional<StiffnessTable> table_behind(const dynamics::MeshExcitation& excitation, const StiffnessTable& table) {
  if (!std::holds_alternative<dynamics::TableStiffness>(excitation)) return std::nullopt;
  auto numbers = table;
  numbers.provenance.clear();
  return numbers;
}

dynamics::StructuralDamping structural_damping(const DynamicsInput& input) {
  return {input.modal_damping_ratio, input.rayleigh_mass, input.rayleigh_stiffness};
}

dynamics::SimulationOptions given_simulation(const DynamicsInput& input, double mesh_frequency) {
  dynamics::SimulationOptions options;
  options.tolerance_rule =
      input.relative_tolerance ? dynamics::ToleranceRule::prescribed : dynamics::ToleranceRule::tightened_if_loose;
  if (input.relative_tolerance) options.integrate_within(*input.relative_tolerance);
  options.integrator.method = input.integrator;
  if (input.steps_per_cycle) options.integrator.fixed_step = 1 / (mesh_frequency * *input.steps_per_cycle);
  options.mesh_cycles = input.mesh_cycles;
  options.other_motions.starts = input.starts;
  return options;
}

dynamics::SimulationOptions accurate_simulation(const Scene& scene, double mesh_frequency) {
  auto options = given_simulation(*scene.dynamics, mesh_frequency);
  const auto choice = motion_choice(scene.accuracy);
  options.samples_per_cycle = choice.samples_per_cycle;
  options.confirmation = choice.confirmation;
  options.confirm_beyond = scene.accuracy;
  options.steady_tolerance = std::max(options.steady_tolerance, choice.steady_tolerance);
  if (!scene.dynamics->relative_tolerance) options.integrator.relative_tolerance = choice.relative_tolerance;
  return options;
}

}  // namespace annulus::app
