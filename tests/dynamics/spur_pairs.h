#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "dynamics/steady_state/steady_response.h"

namespace annulus::dynamics {

/// A spur pair with backlash [KahramanSingh1990] in units of its static deflection and natural frequency:
/// x'' + (1 + ripple cos(speed t)) g(x - e) + 2 zeta (x - e)' = 1, e = error sin(speed t), damping in contact.
struct SpurPair {
  double zeta = 0.03, ripple = 0, error = 0, half_backlash = 1, speed = 1;

  /// As a lumped system with a mass of 2 kg, a stiffness of 5e4 N/m and a load of 30 N.
  static constexpr double mass = 2, stiffness = 5e4, load = 30;
  [[nodiscard]] double rate() const { return std::sqrt(stiffness / mass); }
  [[nodiscard]] double deflection() const { return load / stiffness; }
  [[nodiscard]] LumpedSystem system() const {
    LumpedSystemBuilder builder;
    MeshElement mesh;
    mesh.name = "mesh";
    mesh.b = builder.add_dof("x");
    builder.add_mass(mesh.b, mass);
    builder.add_load(mesh.b, load);
    if (ripple != 0)
      mesh.excitation = HarmonicStiffness{stiffness, ripple, 0};
    else
      mesh.excitation = ConstantStiffness{stiffness};
    mesh.frequency = problem().mesh_frequency;
    mesh.damping = 2 * zeta * std::sqrt(stiffness * mass);
    mesh.half_backlash = half_backlash * deflection();
    if (error != 0) mesh.errors = {{error * deflection(), speed * rate(), 0}};
    builder.add_mesh(mesh);
    return builder.build();
  }
  [[nodiscard]] SteadyProblem problem() const {
    return {.mesh_frequency = speed * rate() / (2 * std::numbers::pi), .force_scale = load, .stiffness = stiffness};
  }
  [[nodiscard]] SystemState state(double x, double v) const {
    SystemState s;
    s.q = Eigen::VectorXd::Constant(1, x * deflection());
    s.v = Eigen::VectorXd::Constant(1, v * deflection() * rate());
    return s;
  }

  /// Force of the mesh in these units.
  [[nodiscard]] double force(double t, double x, double v) const {
    const double delta = x - error * std::sin(speed * t), rate_of_delta = v - error * speed * std::cos(speed * t);
    if (std::abs(delta) <= half_backlash) return 0;
    return (1 + ripple * std::cos(speed * t)) * (delta - std::copysign(half_backlash, delta)) +
           2 * zeta * rate_of_delta;
  }
};

/// Largest force of each of the last `recorded` periods, by fixed steps of the classical Runge-Kutta method from (x, v)
/// at time 0, which are left as they are in the end.
inline std::vector<double> largest_forces(const SpurPair& pair, double& x, double& v, int settling, int recorded) {
  constexpr int steps = 400;
  const double h = 2 * std::numbers::pi / pair.speed / steps;
  const auto acceleration = [&](double t, double y, double w) { return 1 - pair.force(t, y, w); };
  std::vector<double> highest(static_cast<std::size_t>(recorded), 0);
  for (int n = 0; n < settling + recorded; ++n)
    for (int i = 0; i < steps; ++i) {
      const double t = h * i;
      if (n >= settling) {
        auto& high = highest[static_cast<std::size_t>(n - settling)];
        high = std::max(high, pair.force(t, x, v));
      }
      const double k1 = v, l1 = acceleration(t, x, v);
      const double k2 = v + h / 2 * l1, l2 = acceleration(t + h / 2, x + h / 2 * k1, k2);
      const double k3 = v + h / 2 * l2, l3 = acceleration(t + h / 2, x + h / 2 * k2, k3);
      const double k4 = v + h * l3, l4 = acceleration(t + h, x + h * k3, k4);
      x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      v += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
    }
  return highest;
}

}  // namespace annulus::dynamics
