#pragma once

#include <boost/test/unit_test.hpp>
#include <string>

#include "core/errors.h"
#include "core/units.h"
#include "geometry/gear.h"

/// Gears that several test files use.
namespace annulus::geometry::test {

/// The planetary set of the ring paper: module 3.8 mm, 22.5 deg, centre distance 201 mm, five planets.
inline GearParameters paper_gear(GearKind kind, int teeth, double profile_shift) {
  return {.kind = kind,
          .teeth = teeth,
          .module = 3.8 * units::mm,
          .pressure_angle = 22.5 * units::deg,
          .profile_shift = profile_shift,
          .face_width = 88 * units::mm};
}
inline Gear paper_sun() { return Gear(paper_gear(GearKind::external, 48, 0.7608)); }
inline Gear paper_planet() { return Gear(paper_gear(GearKind::external, 55, 0.7361)); }
inline Gear paper_ring() { return Gear(paper_gear(GearKind::internal, 162, 0.1516)); }
inline constexpr double paper_centre_distance = 201 * units::mm;

/// A gear with a module of 2 mm and 20 deg.
inline GearParameters plain_gear(GearKind kind, int teeth, double profile_shift = 0) {
  return {.kind = kind,
          .teeth = teeth,
          .module = 2 * units::mm,
          .pressure_angle = 20 * units::deg,
          .profile_shift = profile_shift,
          .face_width = 20 * units::mm};
}

/// The same gear with a helix angle (of the wanted hand).
inline GearParameters helical(GearParameters p, double helix_angle) {
  p.helix_angle = helix_angle;
  return p;
}

/// Checks that `action` throws GeometryError with `part` in its message.
template <class Action>
void check_refused(const Action& action, const std::string& part) {
  BOOST_CHECK_EXCEPTION(action(), GeometryError, [&](const GeometryError& e) {
    const bool found = std::string(e.what()).find(part) != std::string::npos;
    if (!found) BOOST_TEST_MESSAGE("wanted '" << part << "' in: " << e.what());
    return found;
  });
}

}  // namespace annulus::geometry::test
