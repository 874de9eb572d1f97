#include "dynamics/time_integration/integrator_choice.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "core/errors.h"
#include "dynamics/modes/dense_spectrum.h"

namespace annulus::dynamics {

namespace {

/// Eigenvalues (1/s) of the state matrix with mean mesh stiffness, all teeth in contact.
Eigen::VectorXcd state_eigenvalues(const LumpedSystem& system) {
  const Eigen::Index n = system.dofs();
  Eigen::MatrixXd stiffness = system.stiffness() + system.rotating_stiffness();
  const Eigen::MatrixXd damping = system.damping_with_meshes() + system.gyroscopic();
  for (std::size_t m = 0; m < system.meshes().size(); ++m) {
    const Eigen::VectorXd b = system.mesh_vector(static_cast<int>(m));
    stiffness += mean_stiffness(system.meshes()[m].excitation) * b * b.transpose();
  }
  const Eigen::LLT<Eigen::MatrixXd> mass(system.mass());
  // Velocities / w: entries of similar size.
  const Eigen::MatrixXd rates = mass.solve(stiffness);
  const double w = std::sqrt(std::max(rates.cwiseAbs().maxCoeff(), 1e-300));
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  state.topRightCorner(n, n).setIdentity();
  state.bottomLeftCorner(n, n) = -rates / (w * w);
  state.bottomRightCorner(n, n) = -mass.solve(damping) / w;
  if (!state.allFinite())
    throw InputError(
        fmt::format("a stiffness divided by a mass or an inertia is not a finite number (largest finite rate {:.2g} "
                    "rad/s): a body is too light or too stiff",
                    w));
  return w * eigenvalues(state, "the eigenvalues");
}

/// Stability function of the fifth-order Cash-Karp method.
double growth(std::complex<double> z) {
  return std::abs(1.0 + z * (1.0 + z * (1.0 / 2 + z * (1.0 / 6 + z * (1.0 / 24 + z * (1.0 / 120 + z / 800.0))))));
}

/// Stability function of the classical Runge-Kutta method.
double classical_growth(std::complex<double> z) {
  return std::abs(1.0 + z * (1.0 + z * (1.0 / 2 + z * (1.0 / 6 + z / 24.0))));
}

/// |z| at which a method turns unstable along the direction of the eigenvalue.
double stable_reach(std::complex<double> eigenvalue, double (*growth_of)(std::complex<double>) = growth) {
  const std::complex<double> direction = eigenvalue / std::abs(eigenvalue);
  // Along the imaginary axis Cash-Karp grows by 1e-3 or less per step up to |z| = 0.8: looked for from there on.
  for (double r = 0.8; r < 6; r += 0.02)
    if (growth_of(r * direction) > 1) return r;
  return 6;
}

/// Explicit steps per mesh cycle from which on the L-stable method is cheaper. It takes some hundred steps, each at the
/// cost of thirty to fifty explicit ones. After a jump of the stiffness it follows the fast motion until it has died
/// out to the tolerance: 2/ratio periods of some forty steps. Without damping that never ends.
double explicit_steps_of_implicit(const LumpedSystem& system, double damping_ratio) {
  constexpr double smooth = 8000, after_jumps = 4000;
  return smooth + (std::isfinite(system.next_jump(0)) ? after_jumps / damping_ratio : 0.0);
}

}  // namespace

IntegratorChoice choose_integrator(const LumpedSystem& system, double relative_tolerance) {
  IntegratorChoice choice;
  choice.stability_step = choice.implicit_step = std::numeric_limits<double>::infinity();
  choice.least_damping = 1;
  double frequency = 0;
  for (const auto& mesh : system.meshes()) frequency = std::max(frequency, std::abs(mesh.frequency));
  if (!(frequency > 0) || system.dofs() == 0) {
    choice.reason = "explicit Runge-Kutta: no mesh sets a frequency";
    return choice;
  }
  const double steps_of_bdf = 75 * std::pow(1e-4 / relative_tolerance, 1.0 / 8);
  constexpr double cost_ratio = 2, well_damped = 0.3;
  choice.implicit_step = 1 / (frequency * steps_of_bdf);
  const double break_even = choice.implicit_step / cost_ratio;  // shorter explicit steps cost more
  const Eigen::VectorXcd eigenvalues = state_eigenvalues(system);
  const double zero = 1e-9 * eigenvalues.cwiseAbs().maxCoeff();
  for (const auto& p : eigenvalues) {
    if (std::abs(p) <= zero || p.real() > 0) continue;
    const double step = stable_reach(p) / std::abs(p);
    choice.stability_step = std::min(choice.stability_step, step);
    if (step < break_even) choice.least_damping = std::min(choice.least_damping, -p.real() / std::abs(p));
  }
  const double needed = 1 / (frequency * choice.stability_step);
  choice.explicit_steps = std::max(needed, 1.0);
  if (choice.stability_step >= break_even) {
    choice.reason = fmt::format(
        "explicit Runge-Kutta: stable with {:.0f} steps per mesh cycle; BDF needs {:.0f} steps, each at twice the cost",
        std::ceil(needed), steps_of_bdf);
  } else if (choice.least_damping < well_damped && needed > explicit_steps_of_implicit(system, choice.least_damping)) {
    choice.method = Integrator::arkode_implicit;
    choice.reason = fmt::format(
        "L-stable Runge-Kutta: for stability the explicit method needs {:.2g} steps per mesh cycle, most of them for "
        "motions (damping ratio {:.3f}) that have decayed",
        std::ceil(needed), choice.least_damping);
  } else if (choice.least_damping < well_damped) {
    choice.reason = fmt::format(
        "explicit Runge-Kutta: stiff ({:.0f} steps per mesh cycle for stability), but fast motions are lightly damped "
        "(ratio {:.3f}) and have to be resolved",
        std::ceil(needed), choice.least_damping);
  } else {
    choice.method = Integrator::cvode_bdf;
    choice.reason = fmt::format(
        "BDF: for stability the explicit method needs {:.0f} steps per mesh cycle, BDF needs {:.0f}; the fast motions "
        "are well damped (ratio {:.2f} or more)",
        std::ceil(needed), steps_of_bdf, choice.least_damping);
  }
  return choice;
}

void check_fixed_step(const LumpedSystem& system, double mesh_frequency, double step) {
  double largest = std::numeric_limits<double>::infinity();
  const Eigen::VectorXcd eigenvalues = state_eigenvalues(system);
  const double zero = 1e-9 * eigenvalues.cwiseAbs().maxCoeff();
  for (const auto& p : eigenvalues) {
    if (std::abs(p) <= zero || p.real() > zero) continue;
    // Undamped motions to rounding.
    const std::complex<double> decaying(std::min(p.real(), 0.0), p.imag());
    largest = std::min(largest, stable_reach(decaying, classical_growth) / std::abs(p));
  }
  if (step <= largest) return;
  throw InputError(fmt::format(
      "the fixed-step Runge-Kutta method is unstable with {:.4g} steps per mesh cycle (dynamics.steps_per_cycle): the "
      "fastest motion needs {:.4g}, accuracy needs several times more; other integrators choose their steps",
      1 / (mesh_frequency * step), std::ceil(1 / (mesh_frequency * largest))));
}

}  // namespace annulus::dynamics
