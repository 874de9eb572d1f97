#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/stiffness_table.h"

/// Stiffness tables made by formula.
namespace annulus::dynamics::tables {

/// g = (F/k) (F/nominal)^-bend, so the tangent is the secant / (1 - bend). The stiffness k changes by `ripple` over the
/// mesh cycle and by 5 % around the ring positions; the unloaded transmission error is 1 um in amplitude.
struct BentTable {
  std::string mesh = "ring_planet";
  double mean = 1.87e9, ripple = 0.13, bend = 0.1, nominal = 59.46e3;
  std::vector<double> shares = {0.25, 1, 1.75};  ///< loads over the nominal one
  int phases = 16, positions = 1;

  [[nodiscard]] double stiffness(double cycles) const {
    const double tau = 2 * std::numbers::pi;
    return mean *
           (1 + ripple * std::cos(tau * cycles) + (positions > 1 ? 0.05 * std::cos(tau * cycles / positions) : 0));
  }
  [[nodiscard]] double unloaded_te(double cycles) const { return 1e-6 * std::sin(2 * std::numbers::pi * cycles); }
  [[nodiscard]] double deflection(double cycles, double load) const {
    return load / stiffness(cycles) * std::pow(load / nominal, -bend);
  }
  [[nodiscard]] StiffnessTable table() const {
    std::vector<double> angles, loads;
    std::vector<StiffnessEntry> entries;
    for (const double share : shares) loads.push_back(share * nominal);
    for (int position = 0; position < positions; ++position) {
      angles.push_back(position * 2 * std::numbers::pi / 162);
      for (int phase = 0; phase < phases; ++phase)
        for (const double load : loads) {
          const double cycles = position + static_cast<double>(phase) / phases;
          const double te = unloaded_te(cycles), g = deflection(cycles, load);
          entries.push_back({te, te + g, load / g, load / g / (1 - bend), 0.001});
        }
    }
    return {mesh, phases, angles, loads, entries};
  }
};

}  // namespace annulus::dynamics::tables
