#pragma once

#include <cmath>

#include "geometry/gear_pair.h"

namespace annulus::tests {

/// The planetary set of the ring-type paper: module 3.8 mm, pressure angle 22.5 degrees, centre distance 201 mm.
inline geometry::GearParameters ring_paper_gear(geometry::GearKind kind, int teeth, double profile_shift) {
  geometry::GearParameters p;
  p.kind = kind;
  p.teeth = teeth;
  p.module = 3.8e-3;
  p.pressure_angle = 22.5 * M_PI / 180;
  p.profile_shift = profile_shift;
  p.face_width = 88e-3;
  return p;
}

inline geometry::GearParameters ring_paper_planet() {
  return ring_paper_gear(geometry::GearKind::external, 55, 0.7361);
}
inline geometry::GearParameters ring_paper_sun() { return ring_paper_gear(geometry::GearKind::external, 48, 0.7608); }
inline geometry::GearParameters ring_paper_ring() { return ring_paper_gear(geometry::GearKind::internal, 162, 0.1516); }

inline geometry::GearPair ring_paper_pair(bool internal) {
  return {geometry::Gear(ring_paper_planet()), geometry::Gear(internal ? ring_paper_ring() : ring_paper_sun()), 0.201};
}

}  // namespace annulus::tests
