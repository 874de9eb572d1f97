#include "fem/problem/ring_structure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace annulus::fem {
namespace {

/// Does a turn by `turn` map the angles onto themselves?
bool maps_onto_itself(const std::vector<double>& angles, double turn) {
  constexpr double tolerance = 1e-9;
  return std::all_of(angles.begin(), angles.end(), [&](double angle) {
    return std::any_of(angles.begin(), angles.end(), [&](double other) {
      return std::abs(std::remainder(angle + turn - other, 2 * M_PI)) < tolerance;
    });
  });
}

}  // namespace

std::vector<double> equal_angles(int count, double first) {
  std::vector<double> angles;
  angles.reserve(count);
  for (int i = 0; i < count; ++i) angles.push_back(first + 2 * M_PI * i / count);
  return angles;
}

bool on_single_supports(const RingStructure& structure) {
  return std::holds_alternative<PinHeld>(structure) || std::holds_alternative<SplineHeld>(structure);
}

int repeating_teeth(const RingStructure& structure, int teeth) {
  if (const auto* spline = std::get_if<SplineHeld>(&structure)) return teeth / std::gcd(teeth, spline->teeth);
  const auto* pinned = std::get_if<PinHeld>(&structure);
  if (pinned == nullptr) return 1;
  for (int turned = 1; turned < teeth; ++turned)
    if (teeth % turned == 0 && maps_onto_itself(pinned->angles, 2 * M_PI * turned / teeth)) return turned;
  return teeth;
}

}  // namespace annulus::fem
