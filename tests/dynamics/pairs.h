#pragma once

#include <cmath>

#include "core/units.h"
#include "dynamics/systems/helical_pair/helical_pair.h"

/// Pairs the tests share.
namespace annulus::dynamics::pairs {

inline constexpr double helix = 14 * units::deg, pressure = 20 * units::deg, module = 15e-3;

inline double transverse_pressure() { return std::atan(std::tan(pressure) / std::cos(helix)); }
inline double reference_radius(int teeth) { return module * teeth / (2 * std::cos(helix)); }

/// The pair of the manufacturing-error paper (table 1; docs/helical_pair.md for the inputs that it does not print):
/// 21/37 teeth. Transverse contact ratio 1.6, 1500 r/min and 20 kN m assumed.
inline HelicalPair error_paper() {
  HelicalPair p;
  const auto gear = [](int teeth, double mass) {
    const double r = reference_radius(teeth);
    return PairGear{teeth, mass, 0.5 * mass * r * r, r * std::cos(transverse_pressure()), 2e9, 1e9, {}};
  };
  p.pinion = gear(21, 205);
  p.wheel = gear(37, 289);
  p.base_helix_angle = base_helix_angle(helix, pressure);
  p.mesh = HarmonicStiffness{iso_6336_mesh_stiffness({0.15, 1.6, helix}), 0.05, 0};
  p.mesh_error = {13.1e-6, 0};
  p.mesh_damping_ratio = 0.08;
  p.bearing_damping_ratio = 0.05;
  p.pinion_speed = 1500 * units::rpm;
  p.pinion_torque = 20e3;
  return p;
}

/// Bearings held: the rotations alone.
inline HelicalPair held(HelicalPair p) {
  for (auto* gear : {&p.pinion, &p.wheel}) gear->bearing_transverse = gear->bearing_axial = rigid;
  return p;
}

}  // namespace annulus::dynamics::pairs
