#pragma once

#include <numbers>

#include "core/units.h"
#include "dynamics/systems/two_k_v/arc_tooth.h"
#include "dynamics/systems/two_k_v/two_k_v.h"

namespace annulus::dynamics::stages {

/// The 2K-V-6 reducer: what the paper prints, and the assumed values of docs/arc_tooth_2kv.md. Output held.
inline TwoKVStage reducer() {
  TwoKVStage s;
  s.sun_teeth = 10;
  s.planet_teeth = 34;
  s.arc_teeth = 29;
  s.pins = 30;
  s.module = 1e-3;
  s.pressure_angle = 20 * units::deg;
  s.eccentricity = 0.9e-3;
  s.input_inertia = 8.405e-6;
  s.sun_inertia = 9.2e-8;
  s.planet_inertia = 1.03e-5;
  s.planet_mass = 0.1083;
  s.crank_inertia = 4.6e-7;
  s.arc_inertia = 1.8e-4;
  s.arc_mass = 0.24;
  s.output_inertia = 4.5e-4;
  s.input_shaft = 536;
  s.crank_shaft = 3141;
  s.crank_bearing = s.arc_bearing = 1.5e8;
  s.sun_mesh = ConstantStiffness{1.4e8};
  s.arc_mesh = ConstantStiffness{7.5e8};
  s.output_support = rigid;
  s.output_speed = 30 * 2 * std::numbers::pi / 60;
  s.output_torque = 58;
  return s;
}

/// Its arc-tooth mesh; face width and arc radius assumed.
inline ArcToothMesh arc_mesh() {
  ArcToothMesh m;
  m.pins = 30;
  m.eccentricity = 0.9e-3;
  m.pin_circle_radius = 40e-3;
  m.pin_radius = 2e-3;
  m.arc_radius = 2.2e-3;
  m.width = 8e-3;
  m.youngs_modulus = 2.06e11;
  return m;
}

}  // namespace annulus::dynamics::stages
