#include "fem/problem/ring_structure.h"

#include <algorithm>
#include <cmath>

namespace annulus::fem {

RingDescription OutsideHeld::describe(double /*outside_radius*/) const {
  RingDescription d;
  d.words.name = "outside_held";
  d.words.description = "outer surface fixed";
  d.words.plane_reason = "the outer surface is fixed over the full width";
  return d;
}

bool maps_onto_itself(const std::vector<double>& angles, double angle) {
  constexpr double tolerance = 1e-9;
  return std::all_of(angles.begin(), angles.end(), [&](double own) {
    return std::any_of(angles.begin(), angles.end(), [&](double other) {
      return std::abs(std::remainder(own + angle - other, 2 * M_PI)) < tolerance;
    });
  });
}

int RingStructure::repeating_teeth(int teeth) const {
  const auto angles = value_->describe(0).support_angles;
  for (int turned = 1; turned < teeth; ++turned)
    if (teeth % turned == 0 && maps_onto_itself(angles, 2 * M_PI * turned / teeth)) return turned;
  return teeth;
}

}  // namespace annulus::fem
