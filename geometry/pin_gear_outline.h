#pragma once

#include <Eigen/Core>
#include <vector>

namespace annulus::geometry {

/// A gear inside a circle of fixed pins, with one tooth less than there are pins, on an eccentric (cycloid gear).
struct PinGear {
  int pins = 0;
  double eccentricity = 0;       ///< a, m
  double pin_circle_radius = 0;  ///< R, m; above eccentricity x pins
  double pin_radius = 0;         ///< m
};

/// Closed outline that the pins envelop as the gear rolls among them, counter-clockwise in the gear's frame: the curve
/// at the distance of the pin radius inside the curtate epitrochoid
///   R e^(i t) - a e^(i pins t),  0 <= t < 2 pi,
/// which is the path of a pin's centre. All pins touch it at once. At crank angle 0 the gear's frame stands at
/// (a, 0), not turned, and the first pin at (R, 0). `steps` points per tooth.
[[nodiscard]] std::vector<Eigen::Vector2d> pin_gear_outline(const PinGear& gear, int steps);

}  // namespace annulus::geometry
