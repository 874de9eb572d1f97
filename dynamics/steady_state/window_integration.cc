#include "dynamics/steady_state/window_integration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// Windows over which a decay shows.
constexpr int decay_windows = 8;

/// Is the tolerance out of reach in `left` more windows? The largest differences of eight windows are compared with
/// those of the eight before; in chaos they do not decrease.
bool out_of_reach(const std::vector<double>& differences, int left, double tolerance) {
  if (static_cast<std::ptrdiff_t>(differences.size()) < 2 * decay_windows) return false;
  const auto end = differences.end();
  const double now = *std::max_element(end - decay_windows, end),
               then = *std::max_element(end - 2 * decay_windows, end - decay_windows);
  return now * std::pow(std::min(now / then, 1.0), static_cast<double>(left) / decay_windows) > tolerance;
}

/// Energies between `begin` and `end`. The run may have integrated other windows before.
void set_energy(const SystemState& begin, const SystemState& end, double before, double after, double resolved,
                EnergyBalance& energy) {
  energy.supplied = end.supplied - begin.supplied;
  energy.dissipated = end.dissipated - begin.dissipated;
  energy.change = after - before;
  energy.relative = std::abs(energy.change - energy.supplied + energy.dissipated) /
                    (energy.dissipated + std::max(std::abs(before), std::abs(after)) + resolved);
}

/// Energies below this are not resolved. Displacements are known to a thousandth from a hundred times their tolerance
/// on, and to rounding, which matters where backlash is far wider than deflections.
double resolved_energy(const LumpedSystem& system, const Eigen::VectorXd& displacement, const SteadyProblem& problem,
                       double relative_tolerance) {
  const double resolved = 100 * relative_tolerance * problem.force_scale;
  const Eigen::VectorXd distance = displacement.cwiseAbs();
  const double rounding = 1e-15 * distance.dot(system.stiffness().cwiseAbs() * distance);
  return resolved * resolved / (2 * problem.stiffness) + rounding;
}

}  // namespace

double largest_difference(const ResponseWindow& a, const ResponseWindow& b, double force_scale) {
  return (a.force - b.force.leftCols(a.force.cols())).cwiseAbs().maxCoeff() / force_scale;
}

void WindowIntegration::advance() {
  std::swap(before_, last_);
  begin_ = run_.state();
  run_.pass_jump();
  at_begin_.emplace(run_);
  run_.advance(cycles_, &last_, EnergyTracking::on);
  ++windows_;
}

double WindowIntegration::difference_to_before(double force_scale) const {
  return largest_difference(last_, before_, force_scale);
}

bool WindowIntegration::reach_steady_state(const SimulationOptions& options, double force_scale, Effort effort) {
  double previous = 0;
  std::vector<double> differences;
  bool agreed = false;
  if (windows_ == 0) advance();
  for (int i = 1; i < options.max_windows; ++i) {
    advance();
    const double difference = difference_to_before(force_scale);
    // The sum that a geometric decay at the observed ratio still has ahead. The first difference has no ratio and must
    // be clearly smaller by itself.
    const double ratio = i > 1 ? difference / previous : 0.9;
    const bool agrees = difference <= options.steady_tolerance &&
                        (ratio < 1 ? difference * ratio / (1 - ratio) <= options.steady_tolerance
                                   // No decay left to see: the differences are the integrator's own.
                                   : difference <= 0.5 * options.steady_tolerance);
    // A chaotic motion passes near an unstable periodic one now and then and leaves it again. After so many windows one
    // small difference means nothing.
    if (agrees && (i < decay_windows || agreed)) return true;
    agreed = agrees;
    previous = difference;
    differences.push_back(difference);
    if (effort == Effort::until_out_of_reach &&
        out_of_reach(differences, options.max_windows - i, options.steady_tolerance))
      return false;
  }
  return false;
}

std::optional<double> WindowIntegration::lost_energy(const SteadyProblem& problem,
                                                     const IntegratorOptions& integrator) {
  require(at_begin_.has_value(), fmt::format("an integration ends with a window; {} were integrated", windows_));
  const double resolved = resolved_energy(run_.system(), run_.state().q, problem, integrator.relative_tolerance);
  set_energy(begin_, run_.state(), at_begin_->energy(), run_.energy(), resolved, energy_);
  // Adaptive steps keep the loss near their tolerance in most motions. Impacts add up, and fixed steps may be far too
  // long.
  constexpr double tolerable = 0.05;
  if (energy_.relative <= tolerable) return std::nullopt;
  return energy_.relative;
}

void WindowIntegration::finish(const SimulationOptions& options, SteadyResponse& response) {
  require(at_begin_.has_value(), fmt::format("an integration ends with a window; {} were integrated", windows_));
  response.begin = begin_;
  response.end = run_.state();
  response.energy = energy_;
  if (options.estimate_error) {
    at_begin_->change_accuracy(10);
    response.loose.emplace();
    at_begin_->advance(cycles_, &*response.loose);
  }
  response.best = std::move(last_);
  if (windows_ > 1) response.before = std::move(before_);
  response.total_cycles = run_.cycles();
  response.statistics = run_.statistics();
}

}  // namespace annulus::dynamics
