#include "core/radial_bearing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace annulus {

namespace {

/// Share of the stiffness that is left within the play.
constexpr double unloaded = 1e-7;
/// Steps below this share are lost in rounding.
constexpr double rounding = 1e-15;

/// z - sin z cos z and z + sin z cos z of the half load zone z at p / d. The difference of two small numbers loses
/// digits where the zone is narrow.
struct Zone {
  double angle = 0, force = 0, slope = 0;
};
Zone zone_of(double play, double distance) {
  if (distance <= play) return {};
  const double cosine = play / distance, beyond = (distance - play) / distance;
  const double sine = std::sqrt(beyond * (1 + cosine));
  const double z = 2 * std::asin(std::sqrt(beyond / 2));
  constexpr double narrow = 0.1;
  const double square = z * z;
  const double series = z * square * (2.0 / 3 - square * (2.0 / 15 - square * (4.0 / 315 - square * (2.0 / 2835))));
  const double force = z < narrow ? series : z - sine * cosine;
  return {z, force, z + sine * cosine};
}

}  // namespace

RadialBearing::RadialBearing(double stiffness, double play, double seat)
    : stiffness_(stiffness), play_(play), seat_(seat) {
  if (!(stiffness > 0) || !std::isfinite(stiffness) || !(play >= 0) || !std::isfinite(play) || !(seat > 0))
    throw InputError(fmt::format(
        "a bearing of {:g} N/m with {:g} m of play on a seat of {:g} N/m: stiffnesses must be positive, that "
        "of the bearing finite, and the play must not be negative",
        stiffness, play, seat));
}

RadialBearing::Value RadialBearing::of_rollers(double distance) const {
  const auto zone = zone_of(play_, distance);
  constexpr double scale = (1 - unloaded) * 2 / std::numbers::pi;
  return {stiffness_ * (scale * zone.force + unloaded) * distance, stiffness_ * (scale * zone.slope + unloaded)};
}

double RadialBearing::between_rings(double distance) const {
  if (std::isinf(seat_)) return distance;
  // The force rises ever more steeply: from above Newton's method comes down to the solution without passing it.
  double rings = distance;
  constexpr int steps = 100;
  for (int step = 0; step < steps; ++step) {
    const auto [force, slope] = of_rollers(rings);
    const double change = (force - seat_ * (distance - rings)) / (slope + seat_);
    rings -= change;
    if (!(change > rounding * distance)) return rings;
  }
  throw SolverError(
      fmt::format("a bearing of {:g} N/m with {:g} m of play on a seat of {:g} N/m: no equilibrium at a "
                  "distance of {:g} m",
                  stiffness_, play_, seat_, distance));
}

RadialBearing::Value RadialBearing::operator()(double distance) const {
  const auto value = of_rollers(between_rings(distance));
  return std::isinf(seat_) ? value : Value{value.force, 1 / (1 / value.slope + 1 / seat_)};
}

double RadialBearing::energy(double distance) const {
  const double d = between_rings(distance);
  const auto zone = zone_of(play_, d);
  // The integral of F: of rollers (d cos t - p)^2 / 2 over the load zone. With p = d cos z it is d^2 / 2 times
  // (z + sin z cos z) - 4 sin z cos z + 2 z cos^2 z.
  const double sine = std::sin(zone.angle), cosine = std::cos(zone.angle);
  const double shape = zone.slope - 4 * sine * cosine + 2 * zone.angle * cosine * cosine;
  constexpr double scale = (1 - unloaded) * 2 / std::numbers::pi;
  const double rollers = stiffness_ * d * d / 2 * (scale * shape + unloaded);
  if (std::isinf(seat_)) return rollers;
  return rollers + seat_ * (distance - d) * (distance - d) / 2;
}

double RadialBearing::distance(double force) const {
  return between_rings_under(force) + (std::isinf(seat_) ? 0.0 : force / seat_);
}

double RadialBearing::between_rings_under(double force) const {
  // Within the play only the rest of the stiffness acts; beyond it Newton's method from above, as before.
  if (force <= unloaded * stiffness_ * play_) return force / (unloaded * stiffness_);
  // Steeper than this it never is less: F >= K (d - p 4 / pi), the tangent at infinity.
  double rings = force / stiffness_ + 4 / std::numbers::pi * play_;
  constexpr int steps = 200;
  for (int step = 0; step < steps; ++step) {
    const auto [value, slope] = of_rollers(rings);
    const double change = (value - force) / slope;
    rings -= change;
    if (!(change > rounding * rings)) return rings;
  }
  throw SolverError(
      fmt::format("a bearing of {:g} N/m with {:g} m of play: no distance under {:g} N", stiffness_, play_, force));
}

double RadialBearing::load_zone(double force) const {
  if (play_ == 0) return std::numbers::pi;
  return 2 * zone_of(play_, between_rings_under(force)).angle;
}

double RadialBearing::roller_load(double force, double angle) const {
  return 2 * stiffness_ / std::numbers::pi * std::max(0.0, between_rings_under(force) * std::cos(angle) - play_);
}

}  // namespace annulus
