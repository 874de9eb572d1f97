#include "dynamics/figures/shaft_results.h"

#include <cmath>
#include <cstddef>

#include "core/errors.h"
#include "core/not_known.h"
#include "dynamics/figures/mesh_results.h"

namespace annulus::dynamics {

namespace {

Eigen::Index element_of(const LumpedSystem& system, const std::string& shaft) {
  const auto& meshes = system.meshes();
  for (std::size_t m = 0; m < meshes.size(); ++m)
    if (meshes[m].shaft && meshes[m].name == shaft) return static_cast<Eigen::Index>(m);
  throw InternalError("internal error: no shaft '" + shaft + "'");
}

}  // namespace

std::string torque_key(const ShaftResult& shaft) { return shaft.name + "_torque_Nm"; }

Figure ShaftResult::torque_factor() const {
  if (nominal_torque == 0) return {not_known, not_known};
  return {largest_torque.value / nominal_torque, largest_torque.error / nominal_torque};
}

ShaftResult shaft_result(const LumpedSystem& system, const std::string& element, const ShaftLoad& nominal,
                         const SteadyResponse& found) {
  // In units of 1 N.
  const auto result = branch_results(found, element_of(system, element), 1, 1).front();
  const double r = nominal.radius;
  return {{},
          {},
          r * std::abs(nominal.load),
          r * result.mean_force,
          r * result.smallest_factor,
          {r * result.peak_factor.value, r * result.peak_factor.error},
          result.contact_loss};
}

std::vector<ShaftResult> shaft_results(const LumpedSystem& system, const std::vector<Rotor>& rotors,
                                       const std::vector<ShaftEnd>& ends, const SteadyResponse& found) {
  std::vector<ShaftResult> list;
  for (const auto& rotor : rotors) {
    const auto& end = end_of(rotor, rotors, ends);
    const auto chain = rotors_of(rotors, end.name);
    const int dof = system.find(rotors[chain.back()].name + "_u");
    const double load = system.load()[dof] - system.load(LoadCause::losses)[dof];
    auto& shaft = list.emplace_back(shaft_result(system, rotor.name + "_shaft", {load, end.radius}, found));
    shaft.name = rotor.name;
    shaft.on = rotor.on;
  }
  return list;
}

FigureSpec shaft_figure() {
  return {.key = shaft_key,
          .title = "Largest torque of a shaft",
          .axis = "largest / nominal torque",
          .definition =
              "largest over the shafts of the rotors and the instants of |torque| over the nominal torque; "
              "absent without rotors",
          .better = Better::smaller,
          .headline = true,
          .compared = true,
          .plotted = true,
          .spread = true};
}

std::size_t worst_shaft(const std::vector<ShaftResult>& shafts) {
  require(!shafts.empty(), "no shafts");
  std::size_t worst = 0;
  for (std::size_t i = 1; i < shafts.size(); ++i) {
    const double here = shafts[i].torque_factor().value, there = shafts[worst].torque_factor().value;
    if (here > there || std::isnan(there)) worst = i;
  }
  return worst;
}

void add_shafts(FigureSet& figures, const std::vector<ShaftResult>& shafts) {
  if (!shafts.empty()) figures.set(shaft_key, shafts[worst_shaft(shafts)].torque_factor());
}

void add_each_shaft(FigureSet& figures, const std::vector<ShaftResult>& shafts) {
  for (const auto& shaft : shafts) figures.set(torque_key(shaft), shaft.largest_torque);
}

void set_errors(std::vector<ShaftResult>& shafts, const FigureSet& figures) {
  for (auto& shaft : shafts) shaft.largest_torque.error = figures.figure(torque_key(shaft)).error;
}

}  // namespace annulus::dynamics
