#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <random>

#include "core/units.h"
#include "dynamics/steady_state/piecewise_response.h"
#include "dynamics/systems/planetary/planetary_stage.h"

/// Stages the tests share.
namespace annulus::dynamics::stages {

/// The stage of the ring paper (tables 1 to 3; docs/ring_types.md for the inputs that it does not print): 48/55/162
/// teeth, five planets, harmonic stiffness, eccentricities and pin position errors of the planets with all phases zero.
inline PlanetaryStage ring_paper() {
  PlanetaryStage s;
  s.sun_teeth = 48;
  s.planet_teeth = 55;
  s.ring_teeth = 162;
  const double module = 3.8e-3, base = std::cos(22.5 * units::deg), a = 0.201;
  s.sun.radius = module * 48 / 2 * base;
  s.planet.radius = module * 55 / 2 * base;
  s.ring.radius = module * 162 / 2 * base;
  s.carrier.radius = a;
  s.sun_working_angle = std::acos((s.sun.radius + s.planet.radius) / a);
  s.ring_working_angle = std::acos((s.ring.radius - s.planet.radius) / a);
  s.sun.mass = 66;
  s.sun.inertia = 0.54895;
  s.sun.support = 1e7;
  s.planet.mass = 8.51;
  s.planet.inertia = 0.09282;
  s.planet_bearings = {{1e9, 1e9}};
  s.ring.mass = 31.25;
  s.ring.inertia = 2.9606;
  s.ring.support = 1e9;
  s.ring.torsional_support = 1e10;
  s.carrier.mass = 400.1;
  s.carrier.inertia = 15.3193;
  s.carrier.support = 1e9;
  const double eccentricity[] = {15, 36, 17, 38, 19}, pin_position[] = {11, 32, 13, 34, 15};
  const auto fraction = [](double x) { return x - std::floor(x); };
  for (int n = 0; n < 5; ++n) {
    s.planet_angles.push_back(2 * std::numbers::pi * n / 5);
    s.planet_errors.push_back({{eccentricity[n] * units::um, 0}, {pin_position[n] * units::um, 0}});
    // Parker and Lin 2004: the meshes of planet n follow those of planet 0 by z_s/N (sun) and -z_r/N (ring) cycles.
    s.sun_phase_lag.push_back(fraction(48.0 * n / 5));
    s.ring_phase_lag.push_back(fraction(-162.0 * n / 5));
    s.ring_tooth_offset.push_back(0);
  }
  s.sun_mesh = HarmonicStiffness{1.364e9, 0.2258, 0};
  s.ring_mesh = HarmonicStiffness{1.87e9, 0.1294, 0};
  s.set_half_backlash(50e-6);
  s.mesh_damping_ratio = 0.07;
  s.support_damping_ratio = 0.03;
  s.carrier_speed = 1128 * units::rpm * 48 / (48 + 162);
  s.sun_torque = 2958.8e3 / (1128 * units::rpm);
  return s;
}

/// The stage of [LinParker1999]: inertias are given as I/r^2, so every radius is 1 m.
inline PlanetaryStage lin_parker(int planets) {
  PlanetaryStage s;
  s.sun = {0.4, 0.39, 1, 1e8, 0, {}};
  s.ring = {2.35, 3.00, 1, 1e8, 1e9, {}};
  s.carrier = {5.43, 6.29, 1, 1e8, 0, {}};
  s.planet = {0.66, 0.61, 1};
  s.planet_bearings = {{1e8, 1e8}};
  s.sun_working_angle = s.ring_working_angle = 24.6 * units::deg;
  s.sun_mesh = s.ring_mesh = ConstantStiffness{5e8};
  for (int n = 0; n < planets; ++n) s.planet_angles.push_back(2 * std::numbers::pi * n / planets);
  return s;
}

/// The reducer of the backlash paper [WangLiYaoYi2016]: 26/39/106 teeth, three planets, rectangular stiffnesses, no
/// errors. Ring held; planets, carrier and sun free to turn, the sun floating: 7 DOFs. Printed are equivalent masses
/// I/r^2, r base radii and (r_bs + r_br)/2 for the carrier; the planets' own mass is taken as part of the carrier's.
/// Not printed: the phase between sun and ring mesh, here none.
inline PlanetaryStage backlash_paper() {
  PlanetaryStage s;
  s.sun_teeth = 26;
  s.planet_teeth = 39;
  s.ring_teeth = 106;
  const double angle = 20 * units::deg, module = 1.75e-3, base = std::cos(angle);
  s.sun.radius = module * 26 / 2 * base;
  s.planet.radius = module * 39 / 2 * base;
  s.ring.radius = module * 106 / 2 * base;
  const double carrier = (s.sun.radius + s.ring.radius) / 2;
  s.carrier.radius = carrier / base;  // 57.75 mm
  s.sun_working_angle = s.ring_working_angle = angle;
  s.sun.mass = 0.386;
  s.sun.inertia = 0.246 * s.sun.radius * s.sun.radius;
  s.sun.support = 3e6;
  s.ring.mass = s.ring.inertia = 1;  // held
  s.ring.torsional_support = rigid;
  s.carrier.mass = 1;  // held
  s.carrier.inertia = 1.153 * carrier * carrier;
  s.planet.mass = 1e-9;
  s.planet.inertia = 0.690 * s.planet.radius * s.planet.radius;
  const auto fraction = [](double x) { return x - std::floor(x); };
  for (int n = 0; n < 3; ++n) {
    s.planet_angles.push_back(2 * std::numbers::pi * n / 3);
    s.sun_phase_lag.push_back(fraction(26.0 * n / 3));
    s.ring_phase_lag.push_back(fraction(-106.0 * n / 3));
    s.ring_tooth_offset.push_back(0);
  }
  s.sun_mesh = RectangularStiffness{4.5e8, 0.35, 0.6, 0};
  s.ring_mesh = RectangularStiffness{5.5e8, 0.25, 0.6, 0};
  s.set_half_backlash(50e-6);
  s.mesh_damping_ratio = s.support_damping_ratio = 0.03;
  s.carrier_speed = 1500 * units::rpm * 26 / (26 + 106);
  s.sun_torque = 50;
  return s;
}

/// State (q, v) of n DOFs: displacements up to 0.1 mm, velocities up to 0.1 m/s.
inline Eigen::VectorXd random_state(int n, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::VectorXd y(2 * n);
  for (int i = 0; i < n; ++i) y[i] = 1e-4 * uniform(engine);
  for (int i = 0; i < n; ++i) y[n + i] = 0.1 * uniform(engine);
  return y;
}

}  // namespace annulus::dynamics::stages

namespace annulus::dynamics {

/// Harmonic balance and exact solution of a stage alone, over its error period.
inline PeriodicResponse periodic_response(const PlanetaryStage& stage, const PeriodicOptions& options = {}) {
  const int cycles = stage.error_period();
  return periodic_response(assemble(stage), cycles / stage.mesh_frequency(), cycles, options);
}
inline PiecewiseResponse piecewise_response(const PlanetaryStage& stage, int samples_per_cycle = 32) {
  const int cycles = stage.error_period();
  return piecewise_response(assemble(stage), cycles / stage.mesh_frequency(), cycles, samples_per_cycle);
}

/// Sum of the terms of a transmission error at a time (s), and its rate.
struct MeshError {
  double value = 0, rate = 0;
};
inline MeshError sum_of(const std::vector<HarmonicError>& errors, double time) {
  MeshError e;
  for (const auto& h : errors) {
    e.value += h.amount * std::sin(h.rate * time + h.phase);
    e.rate += h.amount * h.rate * std::cos(h.rate * time + h.phase);
  }
  return e;
}
inline MeshError sun_mesh_error(const PlanetaryStage& stage, int n, double time) {
  return sum_of(sun_mesh_errors(stage, n), time);
}
inline MeshError ring_mesh_error(const PlanetaryStage& stage, int n, double time) {
  return sum_of(ring_mesh_errors(stage, n), time);
}

}  // namespace annulus::dynamics
