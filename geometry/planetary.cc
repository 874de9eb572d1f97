#include "geometry/planetary.h"

#include <fmt/format.h>

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

}  // namespace

PlanetarySet::PlanetarySet(const Gear& sun, const Gear& planet, const Gear& ring, double centre_distance, int planets)
    : sun_mesh_(planet, sun, centre_distance), ring_mesh_(planet, ring, centre_distance), planets_(planets) {
  if (sun.kind() != GearKind::external || ring.kind() != GearKind::internal) {
    throw GeometryError("a planetary set needs an external sun and an internal ring");
  }
  if (planets < 1) throw GeometryError(fmt::format("a planetary set needs at least one planet, not {}", planets));
  const int teeth = sun.teeth() + ring.teeth();
  if (teeth % planets != 0) {
    throw GeometryError(
        fmt::format("assembly condition violated: (z_sun + z_ring) / planets = ({} + {}) / {} = {:.4f} has to be a "
                    "whole number; change a tooth number or the number of planets",
                    sun.teeth(), ring.teeth(), planets, static_cast<double>(teeth) / planets));
  }
  if (planets > 1) {
    const double gap = 2 * centre_distance * std::sin(std::numbers::pi / planets) - 2 * planet.tip_radius();
    const double needed = planet_clearance * planet.parameters().module;
    if (gap < needed) {
      throw GeometryError(
          fmt::format("neighbouring planets collide: their tip circles are {:.4f} mm apart, at least {} modules = "
                      "{:.4f} mm are needed; use fewer planets or a smaller tip diameter (now {:.4f} mm)",
                      gap / units::mm, planet_clearance, needed / units::mm, 2 * planet.tip_radius() / units::mm));
    }
  }
}

double PlanetarySet::planet_angle(int n) const {
  require(n >= 0 && n < planets_, "planet number out of range");
  return 2 * std::numbers::pi * n / planets_;
}

// The sun's leading flanks pass the pitch point of planet 0 (polar angle 0) at f t = 0, 1, ...; that of planet n lies
// z_s phi_n / 2 pi tooth pitches further, so the same flank arrives so many cycles later.
double PlanetarySet::sun_phase_lag(int n) const {
  require(n >= 0 && n < planets_, "planet number out of range");
  return cycle_fraction(static_cast<double>(sun().teeth()) * n / planets_);
}

// At f t = 0 a leading flank of planet 0 stands at the sun's pitch point, at the angle pi seen from the planet's
// centre. The trailing flank of the same tooth, which drives the ring, stands both half tooth angles earlier, each at
// its own working pitch circle. The planet turns clockwise, one tooth per cycle, so a trailing flank reaches the angle
// 0 after (pi - half_s - half_r) z_p / 2 pi cycles. The ring turns clockwise, too: a leading flank of the ring that
// passes planet 0 now passed planet n (counter-clockwise of it) z_r phi_n / 2 pi cycles ago.
double PlanetarySet::ring_phase_lag(int n) const {
  require(n >= 0 && n < planets_, "planet number out of range");
  const auto half_angle = [this](const GearPair& pair) {
    return planet().tooth_half_angle(planet().base_radius() / std::cos(pair.working_pressure_angle()));
  };
  const double turn = std::numbers::pi - half_angle(sun_mesh_) - half_angle(ring_mesh_);
  return cycle_fraction(turn / planet().pitch_angle() - static_cast<double>(ring().teeth()) * n / planets_);
}

double PlanetarySet::ring_tooth_offset(int n) const {
  const double further = static_cast<double>(ring().teeth()) * n / planets_;
  return std::round(further + ring_phase_lag(n) - ring_phase_lag(0));
}

}  // namespace annulus::geometry
