#include "dynamics/steady_state/shooting.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/errors.h"
#include "dynamics/modes/dense_spectrum.h"
#include "dynamics/time_integration/integrator_choice.h"

namespace annulus::dynamics {

namespace {

/// P in the scaled state (q, v/rate).
class PeriodMap {
 public:
  PeriodMap(const LumpedSystem& system, double period, double rate, IntegratorOptions integrator)
      : system_(system), period_(period), rate_(rate), integrator_(integrator), workspace_(system.workspace()) {
    if (integrator_.method == Integrator::automatic)
      integrator_.method = choose_integrator(system, integrator_.relative_tolerance).method;
  }

  [[nodiscard]] Eigen::VectorXd scaled(const SystemState& state) const {
    Eigen::VectorXd y(2 * system_.dofs());
    y << state.q, state.v / rate_;
    return y;
  }
  [[nodiscard]] SystemState state(const Eigen::VectorXd& y) const {
    SystemState state;
    state.q = y.head(system_.dofs());
    state.v = rate_ * y.tail(system_.dofs());
    return state;
  }
  Eigen::VectorXd operator()(const Eigen::VectorXd& y) {
    SystemState at = state(y);
    integrate(system_, at, period_, integrator_, workspace_);
    return scaled(at);
  }

 private:
  const LumpedSystem& system_;
  double period_, rate_;
  IntegratorOptions integrator_;
  LumpedSystem::Workspace workspace_;
};

Eigen::VectorXcd sorted_multipliers(const Eigen::MatrixXd& derivative) {
  const Eigen::VectorXcd found = eigenvalues(derivative, "the Floquet multipliers");
  std::vector<std::complex<double>> values(found.begin(), found.end());
  std::stable_sort(values.begin(), values.end(), [](auto a, auto b) { return std::abs(a) > std::abs(b); });
  return Eigen::Map<Eigen::VectorXcd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

ShootingResult shoot(const LumpedSystem& system, double period, const SystemState& guess,
                     const ShootingOptions& options) {
  require(period > 0 && options.displacement > 0 && options.rate > 0 && options.tolerance > 0,
          fmt::format("shooting needs positive scales: period {} s, displacement {} m, rate {} rad/s, tolerance {} m",
                      period, options.displacement, options.rate, options.tolerance));
  PeriodMap map(system, period, options.rate, options.integrator);
  Eigen::VectorXd y = map.scaled(guess), reached = map(y);
  const Eigen::Index n = y.size();
  Eigen::MatrixXd derivative(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    derivative.col(i) = (map(y + options.displacement * Eigen::VectorXd::Unit(n, i)) - reached) / options.displacement;
  // A rigid motion leaves a zero (its double unit multiplier is known to the accuracy of the integration only): the
  // solution of least length stays near the guess there.
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-4 * options.integrator.relative_tolerance / 1e-6);
  solver.compute(Eigen::MatrixXd::Identity(n, n) - derivative);
  ShootingResult result;
  result.multipliers = sorted_multipliers(derivative);
  for (;; ++result.iterations) {
    result.residual = (reached - y).cwiseAbs().maxCoeff();
    result.converged = result.residual <= options.tolerance;
    if (result.converged || result.iterations == options.max_iterations) break;
    y += solver.solve(reached - y);
    reached = map(y);
  }
  result.start = map.state(y);
  return result;
}

}  // namespace annulus::dynamics
