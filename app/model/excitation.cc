#include "app/model/excitation.h"

#include "core/error_parts.h"
#include "core/errors.h"

namespace annulus::app {

dynamics::MeshExcitation excitation_of(const MeshInput& input, const MeshResult& mesh, double nominal_load,
                                       dynamics::LoadDependence dependence) {
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
  return dynamics::table_stiffness(mesh.table, nominal_load, 0, dependence);
}

void add_excitation(ContentId& id, const std::string& name, const dynamics::MeshExcitation& excitation,
                    const StiffnessTable& table) {
  if (const auto* c = std::get_if<dynamics::ConstantStiffness>(&excitation)) {
    id.add(name + ".constant", c->mean);
  } else if (const auto* h = std::get_if<dynamics::HarmonicStiffness>(&excitation)) {
    id.add(name + ".harmonic", h->mean).add(name + ".ripple", h->ripple).add(name + ".shift", h->phase_shift);
  } else if (const auto* r = std::get_if<dynamics::RectangularStiffness>(&excitation)) {
    id.add(name + ".rectangular", r->mean).add(name + ".ripple", r->ripple);
    id.add(name + ".duty", r->duty).add(name + ".shift", r->phase_shift);
  } else {
    // Whatever made the table, its numbers are what the response depends on.
    require(table.phases() > 0, "a tabulated stiffness has a table: " + name);
    id.add(name + ".all_loads", std::get<dynamics::TableStiffness>(excitation).surface ? 1 : 0);
    for (const double load : table.loads()) id.add(name + ".load", load);
    for (int position = 0; position < table.positions(); ++position) {
      for (int phase = 0; phase < table.phases(); ++phase) {
        for (int load = 0; load < static_cast<int>(table.loads().size()); ++load) {
          const auto& e = table.at(position, phase, load);
          id.add("u", e.unloaded_te)
              .add("k", e.stiffness_secant)
              .add("t", e.stiffness_tangent)
              .add("error", e.error_relative);
          for (const auto& [part, member] : stiffness_error_part_names) id.add(part, e.error_parts.*member);
        }
      }
    }
  }
}

dynamics::SimulationOptions given_simulation(const DynamicsInput& input, double mesh_frequency) {
  dynamics::SimulationOptions options;
  if (input.relative_tolerance) options.integrate_within(*input.relative_tolerance);
  options.integrator.method = input.integrator;
  if (input.steps_per_cycle) options.integrator.fixed_step = 1 / (mesh_frequency * *input.steps_per_cycle);
  options.mesh_cycles = input.mesh_cycles;
  return options;
}

void add_simulation(ContentId& id, const dynamics::SimulationOptions& o) {
  id.add("steady_state", static_cast<int>(o.steady_state)).add("confirm", o.confirm ? 1 : 0);
  id.add("confirm_on_contact_loss", o.confirm_on_contact_loss ? 1 : 0).add("estimate_error", o.estimate_error ? 1 : 0);
  id.add("method", static_cast<int>(o.integrator.method)).add("tolerance", o.integrator.relative_tolerance);
  id.add("absolute_tolerance", o.integrator.absolute_tolerance.value_or(0)).add("fixed_step", o.integrator.fixed_step);
  id.add("mesh_cycles", o.mesh_cycles.value_or(0)).add("steady_tolerance", o.steady_tolerance);
  id.add("samples", o.samples_per_cycle).add("windows", o.max_windows);
  id.add("min_window", o.min_window_cycles).add("max_window", o.max_window_cycles);
}

}  // namespace annulus::app
