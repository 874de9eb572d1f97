#include "app/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace annulus::app {

Quantity quantity(std::string key, double value, std::string meaning) {
  static constexpr struct {
    const char *ending, *unit;
    double si;
  } units_of_keys[] = {{"_mm", "mm", units::mm},  {"_um", "µm", units::um},
                       {"_deg", "°", units::deg}, {"_rpm", "r/min", units::rpm},
                       {"_Hz", "Hz", 1},          {"_N", "N", 1},
                       {"_kN", "kN", 1e3},        {"_Nm", "N m", 1},
                       {"_N_m", "N m", 1},        {"_cycles", "mesh cycles", 1},
                       {"_N_per_m", "N/m", 1}};
  for (const auto& [ending, unit, si] : units_of_keys)
    if (key.ends_with(ending)) return {std::move(key), value / si, unit, std::move(meaning)};
  return {std::move(key), value, "", std::move(meaning)};
}

DofPlan supported_dof(std::string name, const std::string& support, double given, double effective, const char* unit) {
  const bool retained = std::isfinite(effective);
  if (!std::isfinite(given)) return {std::move(name), retained, fmt::format("rigid {}: dropped", support)};
  if (given == 0) return {std::move(name), retained, fmt::format("no {}: free to move", support)};
  return {std::move(name), retained,
          fmt::format("{} of {} {}{}", support, to_text(given), unit,
                      retained ? "" : " deflects by less than a thousandth of the accuracy: dropped")};
}

bool Plan::computes() const {
  return std::any_of(meshes.begin(), meshes.end(), [](const MeshModel& mesh) { return mesh.computed(); });
}

long Plan::contact_problems() const {
  long count = 0;
  for (const auto& mesh : meshes) {
    if (!mesh.computed()) continue;
    count +=
        (static_cast<long>(mesh.positions) * mesh.problem->phases + 1) * static_cast<long>(mesh.problem->loads.size());
  }
  return count;
}

void add_diameters(std::vector<DerivedInput>& list, const std::string& table, const geometry::Gear& gear,
                   const std::string& variant) {
  list.push_back({table + ".tip_diameter_mm", variant, 2 * gear.tip_radius() / units::mm});
  list.push_back({table + ".root_diameter_mm", variant, 2 * gear.root_radius() / units::mm});
}

std::vector<Input> resolved_inputs(const Scene& scene, const std::vector<DerivedInput>& derived) {
  std::vector<Input> list;
  for (const auto& input : scene.inputs) {
    if (!std::holds_alternative<std::monostate>(input.value)) {
      list.push_back(input);
      continue;
    }
    const auto found = std::find_if(derived.begin(), derived.end(), [&](const DerivedInput& d) {
      return d.key == input.key && d.variant == input.variant;
    });
    if (found == derived.end()) continue;
    list.push_back(input);
    list.back().value = found->value;
    list.back().origin = Origin::derived;
    if (!found->note.empty()) list.back().note = found->note;
  }
  return list;
}

}  // namespace annulus::app
