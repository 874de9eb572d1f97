#include "dynamics/optimisation/optimise_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"

namespace annulus::dynamics {

std::vector<double> OptimiseLog::point(const std::vector<double>& unit) const {
  std::vector<double> x(unit.size());
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const auto& v = variables_[i];
    // Whole numbers own equal shares of the unit interval. The ends meet the bounds but for rounding.
    const double low = v.whole ? v.low - 0.5 : v.low, high = v.whole ? v.high + 0.5 : v.high;
    double value = v.logarithmic ? low * std::pow(high / low, unit[i]) : low + unit[i] * (high - low);
    if (v.whole) value = std::round(value);
    x[i] = std::clamp(value, v.low, v.high);
  }
  return x;
}

double OptimiseLog::evaluate(const std::vector<double>& unit) {
  auto x = point(unit);
  const auto found = known_.find(x);
  if (found != known_.end()) {
    ++repeated_;
    return found->second;
  }
  OptimiseEvaluation evaluation;
  try {
    evaluation.value = objective_(x);
    if (!std::isfinite(evaluation.value)) evaluation.trouble = fmt::format("the objective is {}", evaluation.value);
  } catch (const InputError& e) {
    evaluation.trouble = e.what();
  } catch (const SolverError& e) {
    evaluation.trouble = e.what();
  }
  if (!evaluation.trouble.empty()) {
    evaluation.value = std::numeric_limits<double>::quiet_NaN();
    ++failed_;
  } else if (best_ < 0 || evaluation.value < evaluations_[best_].value) {
    best_ = static_cast<std::ptrdiff_t>(evaluations_.size());
  }
  const double value = evaluation.trouble.empty() ? evaluation.value : penalty;
  evaluation.x = x;
  evaluations_.push_back(std::move(evaluation));
  known_.emplace(std::move(x), value);
  return value;
}

const OptimiseEvaluation* OptimiseLog::best() const { return best_ < 0 ? nullptr : &evaluations_[best_]; }

OptimiseGeneration OptimiseLog::generation(int number, const std::vector<std::vector<double>>& values) const {
  OptimiseGeneration g;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  g.generation = number;
  g.evaluations = static_cast<long>(evaluations_.size());
  g.best = best() ? best()->value : none;
  g.mean = g.worst = none;
  double sum = 0;
  for (const auto& value : values) {
    if (value[0] == penalty) {
      ++g.failed;
      continue;
    }
    sum += value[0];
    g.worst = std::isnan(g.worst) ? value[0] : std::max(g.worst, value[0]);
  }
  const auto good = static_cast<int>(values.size()) - g.failed;
  if (good > 0) g.mean = sum / good;
  return g;
}

std::string OptimiseLog::first_trouble() const {
  const auto found = std::find_if(evaluations_.begin(), evaluations_.end(),
                                  [](const OptimiseEvaluation& e) { return !e.trouble.empty(); });
  return found == evaluations_.end() ? std::string{} : found->trouble;
}

void OptimiseLog::move_to(OptimiseResult& result) {
  result.x = best()->x;
  result.value = best()->value;
  result.repeated = repeated_;
  result.failed = failed_;
  result.evaluations = std::move(evaluations_);
}

std::optional<long> evaluations_to_reach(const std::vector<OptimiseEvaluation>& evaluations, double value,
                                         double tolerance) {
  const auto found = std::find_if(evaluations.begin(), evaluations.end(),
                                  [&](const OptimiseEvaluation& e) { return e.value <= value + tolerance; });
  if (found == evaluations.end()) return std::nullopt;
  return found - evaluations.begin() + 1;
}

ObjectiveRange objective_range(const std::vector<OptimiseEvaluation>& evaluations, double numerical_error) {
  if (!(numerical_error >= 0))
    throw InputError(fmt::format("the numerical error {} of an objective must not be negative", numerical_error));
  ObjectiveRange range;
  range.low = std::numeric_limits<double>::infinity();
  range.high = -range.low;
  for (const auto& e : evaluations) {
    if (std::isnan(e.value)) continue;
    ++range.evaluations;
    range.low = std::min(range.low, e.value);
    range.high = std::max(range.high, e.value);
  }
  if (range.evaluations < 2) {
    range.verdict = fmt::format("{} evaluations are too few to judge the shape of the objective", range.evaluations);
    return range;
  }
  constexpr double relative = 1e-6;
  range.least_meaning = std::max(numerical_error, relative * std::max(std::abs(range.low), std::abs(range.high)));
  const double difference = range.high - range.low;
  range.flat = difference <= range.least_meaning;
  range.verdict = range.flat
                      ? fmt::format(
                            "flat: over {} points the objective varies by {:.2g}; differences below {:.2g} are not "
                            "significant, so no point is better than another",
                            range.evaluations, difference, range.least_meaning)
                      : fmt::format(
                            "over {} points the objective varies by {:.4g}, from {:.6g} to {:.6g}; differences below "
                            "{:.2g} are not significant",
                            range.evaluations, difference, range.low, range.high, range.least_meaning);
  return range;
}

}  // namespace annulus::dynamics
