#include "fem/closed_form/helical_table.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "fem/closed_form/closed_form_mesh.h"

namespace annulus::fem {
namespace {

/// The same teeth as a spur gear: module, pressure angle and shift of the transverse section.
geometry::Gear transverse_section(const geometry::Gear& gear) {
  auto p = gear.parameters();
  const double c = std::cos(p.helix_angle);
  p.module = gear.transverse_module();
  p.pressure_angle = gear.transverse_pressure_angle();
  p.profile_shift *= c;
  p.root_fillet_factor *= c;
  p.protuberance *= std::cos(gear.transverse_pressure_angle()) / (std::cos(gear.parameters().pressure_angle) * c);
  p.protuberance_angle = std::atan(std::tan(p.protuberance_angle) / c);
  p.tip_diameter = 2 * gear.tip_radius();
  p.root_diameter = 2 * gear.root_radius();
  p.helix_angle = 0;
  return geometry::Gear(p);
}

}  // namespace

std::string no_helical_closed_form(const geometry::GearParameters& pinion, const geometry::GearParameters& wheel,
                                   double misalignment) {
  if (geometry::modified(pinion) || geometry::modified(wheel))
    return "flanks with modifications have no closed form here";
  return misalignment != 0 ? "misaligned flanks have no closed form" : "";
}

StiffnessTable helical_closed_form(const LoadedMeshProblem& problem) {
  const auto& pair = problem.pair;
  const auto why = no_helical_closed_form(pair.pinion().parameters(), pair.wheel().parameters(), problem.misalignment);
  if (!why.empty()) throw InputError("no closed form: " + why);
  LoadedMeshProblem section = problem;
  section.pair = {transverse_section(pair.pinion()), transverse_section(pair.wheel()), pair.centre_distance()};
  LoadedMeshSettings settings;
  settings.fidelity = Fidelity::closed_form;
  const auto spur = solve_closed_form(section, settings).table;
  constexpr int slices = 64;
  const int phases = problem.phases, loads = static_cast<int>(problem.loads.size());
  std::vector<StiffnessEntry> entries(static_cast<std::size_t>(phases) * loads);
  for (int load = 0; load < loads; ++load) {
    const auto curves = curves_at_load(spur, problem.loads[load]);
    for (int i = 0; i < phases; ++i) {
      auto& e = entries[static_cast<std::size_t>(i) * loads + load];
      for (int j = 0; j < slices; ++j) {
        const double cycles = static_cast<double>(i) / phases + pair.overlap_ratio() * ((j + 0.5) / slices - 0.5);
        e.stiffness_secant += curves.stiffness_secant(cycles) / slices;
        e.stiffness_tangent += curves.stiffness_tangent(cycles) / slices;
      }
      e.lte = problem.loads[load] / e.stiffness_secant;
      e.error_relative = spur.at(0, i, load).error_relative;
      e.error_parts = spur.at(0, i, load).error_parts;
    }
  }
  return {problem.name, phases, {0.0}, problem.loads, std::move(entries)};
}

StiffnessTable along_normal(const StiffnessTable& transverse, double base_helix_angle) {
  const double c = std::cos(base_helix_angle);
  auto loads = transverse.loads();
  for (auto& load : loads) load /= c;
  std::vector<StiffnessEntry> entries;
  for (int position = 0; position < transverse.positions(); ++position)
    for (int phase = 0; phase < transverse.phases(); ++phase)
      for (int load = 0; load < static_cast<int>(loads.size()); ++load) {
        auto e = transverse.at(position, phase, load);
        e.unloaded_te *= c;
        e.lte *= c;
        e.stiffness_secant /= c * c;
        e.stiffness_tangent /= c * c;
        entries.push_back(e);
      }
  return {transverse.mesh(), transverse.phases(), transverse.ring_angles(), std::move(loads), std::move(entries)};
}

}  // namespace annulus::fem
