#include "dynamics/optimisation/optimise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "core/errors.h"
#include "core/loaded_library.h"
#include "dynamics/optimisation/optimisers.h"

namespace annulus::dynamics {

namespace {

/// The objective for an optimiser: a finite function on the unit cube that computes no point twice and stores all.
class OptimiseLog {
 public:
  OptimiseLog(const std::vector<OptimiseVariable>& variables, const Objective& objective)
      : variables_(variables), objective_(objective) {}

  /// Value of a failed point: worse than any value met, now or later.
  static constexpr double penalty = 1e300;

  [[nodiscard]] double evaluate(const std::vector<double>& unit);
  [[nodiscard]] std::vector<double> point(const std::vector<double>& unit) const;
  /// The points that are not known yet, each once.
  [[nodiscard]] std::vector<std::vector<double>> unknown(const std::vector<std::vector<double>>& units) const;
  [[nodiscard]] long asked() const { return static_cast<long>(evaluations_.size()) + repeated_; }
  [[nodiscard]] const OptimiseEvaluation* best() const;
  [[nodiscard]] OptimiseGeneration generation(int number, const std::vector<double>& values) const;
  void move_to(OptimiseResult& result);
  [[nodiscard]] std::string first_trouble() const;

 private:
  const std::vector<OptimiseVariable>& variables_;
  const Objective& objective_;
  std::map<std::vector<double>, double> known_;
  std::vector<OptimiseEvaluation> evaluations_;
  long repeated_ = 0, failed_ = 0;
  std::ptrdiff_t best_ = -1;
};

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

std::vector<std::vector<double>> OptimiseLog::unknown(const std::vector<std::vector<double>>& units) const {
  std::vector<std::vector<double>> points;
  std::set<std::vector<double>> seen;
  for (const auto& unit : units) {
    auto x = point(unit);
    if (!known_.contains(x) && seen.insert(x).second) points.push_back(std::move(x));
  }
  return points;
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
    evaluation.value = not_known;
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

OptimiseGeneration OptimiseLog::generation(int number, const std::vector<double>& values) const {
  OptimiseGeneration g;
  g.generation = number;
  g.evaluations = static_cast<long>(evaluations_.size());
  g.best = best() ? best()->value : not_known;
  g.mean = g.worst = not_known;
  double sum = 0;
  for (const double value : values) {
    if (value == penalty) {
      ++g.failed;
      continue;
    }
    sum += value;
    g.worst = std::isnan(g.worst) ? value : std::max(g.worst, value);
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

void check(const std::vector<OptimiseVariable>& variables, const OptimiseOptions& o) {
  if (variables.empty()) throw InputError("an optimisation needs at least one variable, and has none");
  for (const auto& v : variables) {
    const auto refuse = [&](const char* what) {
      throw InputError(fmt::format("{}: bounds {} ... {} {}", v.name, v.low, v.high, what));
    };
    if (!std::isfinite(v.low) || !std::isfinite(v.high)) refuse("must be finite");
    if (!(v.low < v.high)) refuse("must rise");
    if (v.logarithmic && !(v.low > 0)) refuse("must be positive on a logarithmic scale");
    if (v.whole && (v.low != std::round(v.low) || v.high != std::round(v.high))) refuse("must be whole numbers");
  }
  if (o.generations < 1)
    throw InputError(fmt::format("an optimisation needs at least one generation, not {}", o.generations));
  if (o.population < 5) throw InputError(fmt::format("a population of {} is too small: at least 5", o.population));
  if (o.optimiser == Optimiser::genetic && o.population % 2 != 0)
    throw InputError(
        fmt::format("a population of {} cannot pair: the genetic algorithm needs an even one", o.population));
  if (!(o.elite > 0 && o.elite <= 1)) throw InputError(fmt::format("elite share {} must lie in (0, 1]", o.elite));
  for (const auto& [value, name] : {std::pair{o.crossover, "crossover"}, std::pair{o.mutation, "mutation"}})
    if (!(value >= 0 && value <= 1)) throw InputError(fmt::format("{} rate {} must lie in [0, 1]", name, value));
}

}  // namespace

const char* to_text(Optimiser optimiser) {
  switch (optimiser) {
    case Optimiser::genetic:
      return "genetic algorithm";
    case Optimiser::cma_es:
      return "CMA-ES";
    case Optimiser::differential_evolution:
      break;
  }
  return "differential evolution";
}

OptimiseResult optimise(const std::vector<OptimiseVariable>& variables, const Objective& objective,
                        const OptimiseOptions& options, const std::function<void(const OptimiseGeneration&)>& progress,
                        const Ahead& ahead) {
  check(variables, options);
  OptimiseLog log(variables, objective);
  OptimiseResult result;
  result.optimiser = options.optimiser;
  // The same first population for every optimiser of one seed.
  std::seed_seq seeds{static_cast<std::uint32_t>(options.seed), static_cast<std::uint32_t>(options.seed >> 32)};
  unsigned drawn[2];
  seeds.generate(drawn, drawn + 2);
  const auto& optimisers = *static_cast<const Optimisers*>(optimisers_library.table());
  const OptimiserSeeds chance = {drawn[0], drawn[1]};
  const auto name = [&](const std::vector<std::vector<double>>& units) {
    if (const auto points = log.unknown(units); !points.empty()) ahead(points);
  };
  if (ahead) name(optimisers.first_points(options, chance, variables.size()));
  const auto population = optimisers.start(options, chance, variables.size(),
                                           [&log](const std::vector<double>& unit) { return log.evaluate(unit); });
  const auto note = [&](int generation) {
    result.history.push_back(log.generation(generation, population->values()));
    if (progress) progress(result.history.back());
  };
  note(0);
  result.stopped = fmt::format("all {} generations", options.generations);
  for (int generation = 1; generation <= options.generations; ++generation) {
    const long asked = log.asked();
    if (ahead) name(population->next_points());
    population->evolve();
    if (log.asked() == asked) {
      result.stopped = fmt::format("the optimiser had nothing left to try in generation {}", generation);
      break;
    }
    note(generation);
  }
  if (!log.best()) throw SolverError("every point of the optimisation failed, the first: " + log.first_trouble());
  log.move_to(result);
  return result;
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
