#include "geometry/planetary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/units.h"

namespace annulus::geometry {

namespace {

/// x modulo one, in [0, 1); values that are whole up to rounding give 0, not 1 - epsilon.
double cycle_fraction(double x) {
  const double f = x - std::floor(x);
  // Tooth counts of some hundreds leave errors of 1e-13; no true fraction of interest is that near to a whole cycle.
  return f > 1 - 1e-10 || f < 1e-10 ? 0.0 : f;
}

void check_kinds(const Gear& sun, const Gear& ring) {
  if (sun.kind() != GearKind::external || ring.kind() != GearKind::internal)
    throw GeometryError("a planetary set needs an external sun and an internal ring");
}

}  // namespace

PlanetarySet::PlanetarySet(const Gear& sun, const Gear& planet, const Gear& ring, double centre_distance, int planets)
    : sun_mesh_(planet, sun, centre_distance), ring_mesh_(planet, ring, centre_distance) {
  check_kinds(sun, ring);
  if (planets < 1) throw GeometryError(fmt::format("a planetary set needs at least one planet, not {}", planets));
  if (whole_turn() % planets != 0) {
    throw GeometryError(
        fmt::format("assembly condition violated: (z_sun + z_ring) / planets = ({} + {}) / {} = {:.4f} has to be a "
                    "whole number; change a tooth number or the number of planets, or space the planets unequally, at "
                    "multiples of {:.4f} degrees",
                    sun.teeth(), ring.teeth(), planets, static_cast<double>(whole_turn()) / planets,
                    assembly_angle() / units::deg));
  }
  for (int n = 0; n < planets; ++n) steps_.push_back(whole_turn() / planets * n);
  check_room();
}

PlanetarySet::PlanetarySet(const Gear& sun, const Gear& planet, const Gear& ring, double centre_distance,
                           const std::vector<double>& planet_angles)
    : sun_mesh_(planet, sun, centre_distance), ring_mesh_(planet, ring, centre_distance) {
  check_kinds(sun, ring);
  if (planet_angles.empty() || planet_angles.front() != 0)
    throw GeometryError("a planetary set needs at least one planet, and its first one stands at the angle 0");
  for (std::size_t n = 0; n < planet_angles.size(); ++n) {
    const double angle = planet_angles[n];
    if (!std::isfinite(angle)) throw GeometryError(fmt::format("the angle of planet {} is not a number", n + 1));
    if (angle < 0 || angle >= 2 * std::numbers::pi)
      throw GeometryError(
          fmt::format("planet {} at {:.7g} degrees: angles start at 0 and stay below 360", n + 1, angle / units::deg));
    const double step = std::round(angle / assembly_angle());
    if (std::abs(angle - step * assembly_angle()) > angle_tolerance) {
      const double below = std::floor(angle / assembly_angle());
      throw GeometryError(
          fmt::format("assembly condition violated: planet {} at {:.7g} degrees does not fit between the teeth of sun "
                      "and ring: with {} + {} teeth it fits every 360 / {} = {:.6g} degrees; the nearest positions are "
                      "{:.6f} and {:.6f} degrees",
                      n + 1, angle / units::deg, sun.teeth(), ring.teeth(), whole_turn(), assembly_angle() / units::deg,
                      below * assembly_angle() / units::deg, (below + 1) * assembly_angle() / units::deg));
    }
    steps_.push_back(static_cast<int>(step));
  }
  check_room();
}

void PlanetarySet::check_room() const {
  if (planets() == 1) return;
  auto places = steps_;
  std::sort(places.begin(), places.end());
  int nearest = whole_turn() - places.back();
  for (std::size_t n = 1; n < places.size(); ++n) nearest = std::min(nearest, places[n] - places[n - 1]);
  const double gap =
      2 * centre_distance() * std::sin(std::numbers::pi * nearest / whole_turn()) - 2 * planet().tip_radius();
  const double needed = planet_clearance * planet().parameters().module;
  if (gap < needed) {
    throw GeometryError(
        fmt::format("neighbouring planets collide: their tip circles are {:.4f} mm apart, at least {} modules = "
                    "{:.4f} mm are needed; use fewer planets or a smaller tip diameter (now {:.4f} mm)",
                    gap / units::mm, planet_clearance, needed / units::mm, 2 * planet().tip_radius() / units::mm));
  }
}

int PlanetarySet::step(int n) const {
  require(n >= 0 && n < planets(), "planet number out of range");
  return steps_[static_cast<std::size_t>(n)];
}

double PlanetarySet::assembly_angle() const { return 2 * std::numbers::pi / whole_turn(); }

double PlanetarySet::planet_angle(int n) const { return 2 * std::numbers::pi * step(n) / whole_turn(); }

double PlanetarySet::ring_teeth_ahead(int n) const {
  return static_cast<double>(ring().teeth()) * step(n) / whole_turn();
}

// The sun's leading flanks pass the pitch point of planet 0 (polar angle 0) at f t = 0, 1, ...; that of planet n lies
// z_s phi_n / 2 pi tooth pitches further, so the same flank arrives so many cycles later.
double PlanetarySet::sun_phase_lag(int n) const {
  return cycle_fraction(static_cast<double>(sun().teeth()) * step(n) / whole_turn());
}

// At f t = 0 a leading flank of planet 0 stands at the sun's pitch point, at the angle pi seen from the planet's
// centre. The trailing flank of the same tooth, which drives the ring, stands both half tooth angles earlier, each at
// its own working pitch circle. The planet turns clockwise, one tooth per cycle, so a trailing flank reaches the angle
// 0 after (pi - half_s - half_r) z_p / 2 pi cycles. The ring turns clockwise, too: a leading flank of the ring that
// passes planet 0 now passed planet n (counter-clockwise of it) z_r phi_n / 2 pi cycles ago.
double PlanetarySet::ring_phase_lag(int n) const {
  return cycle_fraction(cycles_from_sun_to_ring() - ring_teeth_ahead(n));
}

double PlanetarySet::cycles_from_sun_to_ring() const {
  const auto half_angle = [this](const GearPair& pair) {
    return planet().tooth_half_angle(planet().base_radius() / std::cos(pair.working_pressure_angle()));
  };
  const double turn = std::numbers::pi - half_angle(sun_mesh_) - half_angle(ring_mesh_);
  return turn / planet().pitch_angle();
}

double PlanetarySet::ring_tooth_offset(int n) const {
  return std::round(ring_teeth_ahead(n) + ring_phase_lag(n) - ring_phase_lag(0));
}

}  // namespace annulus::geometry
