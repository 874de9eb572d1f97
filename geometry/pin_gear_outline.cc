#include "geometry/pin_gear_outline.h"

#include <cmath>
#include <complex>
#include <numbers>

namespace annulus::geometry {

std::vector<Eigen::Vector2d> pin_gear_outline(const PinGear& gear, int steps) {
  const int teeth = gear.pins - 1, count = teeth * steps;
  std::vector<Eigen::Vector2d> outline;
  outline.reserve(count);
  for (int i = 0; i < count; ++i) {
    const double t = 2 * std::numbers::pi * i / count;
    const auto turn = std::polar(1.0, t), crank = std::polar(1.0, gear.pins * t);
    // The normal of the contact passes through the pitch point, a x pins from the centre of the pins.
    const auto normal = gear.pin_circle_radius * turn - gear.eccentricity * gear.pins * crank;
    const auto point =
        gear.pin_circle_radius * turn - gear.eccentricity * crank - gear.pin_radius * normal / std::abs(normal);
    outline.emplace_back(point.real(), point.imag());
  }
  return outline;
}

}  // namespace annulus::geometry
