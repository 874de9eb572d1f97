#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/not_known.h"

namespace annulus::dynamics {

/// A quantity that the optimiser varies.
struct OptimiseVariable {
  std::string name;
  double low = 0, high = 0;
  bool logarithmic = false;  ///< searched on the scale of the logarithm (low > 0)
  /// Whole numbers low ... high, equally likely; points that round to the same numbers are one evaluation.
  bool whole = false;
};

enum class Optimiser {
  genetic,                ///< pagmo::sga: truncated selection, simulated binary crossover, polynomial mutation, elitism
  cma_es,                 ///< pagmo::cmaes: covariance matrix adaptation [Hansen2006], within the bounds
  differential_evolution  ///< pagmo::de: rand/1/exp [StornPrice1997]
};
[[nodiscard]] const char* to_text(Optimiser optimiser);

/// Defaults of `generations`, `elite`, `crossover` and `mutation` are those of [WangLiYaoYi2016], whose genetic
/// algorithm is binary; here it is real-coded. The paper does not print its population.
///
/// `elite` is the share of the population that is selected as parents ("truncated" selection of pagmo takes turns among
/// them). Parents and children compete for the next generation, so the best is never lost. A pair is crossed with
/// probability `crossover`, a gene mutates with probability `mutation`.
struct OptimiseOptions {
  Optimiser optimiser = Optimiser::genetic;
  int generations = 200;  ///< after the first population
  int population = 20;    ///< at least 5 (differential evolution, CMA-ES), even (genetic)
  std::uint64_t seed = 1;
  // genetic only
  double elite = 0.2;      ///< in (0, 1]
  double crossover = 0.9;  ///< in [0, 1]
  double mutation = 0.05;  ///< in [0, 1]
};

/// One point that was computed.
struct OptimiseEvaluation {
  std::vector<double> x;
  double value = not_known;  ///< not a number: failed
  std::string trouble;       ///< the cause where it failed, else empty
};

/// State of the population after a generation; 0 is the first population. Failed points are left out of the values.
struct OptimiseGeneration {
  int generation = 0;
  long evaluations = 0;  ///< computed so far
  double best = 0;       ///< best of all evaluations so far
  double mean = 0, worst = 0;
  int failed = 0;  ///< of the population
};

struct OptimiseResult {
  Optimiser optimiser = Optimiser::genetic;
  std::vector<double> x;  ///< best point
  double value = 0;       ///< there
  std::vector<OptimiseGeneration> history;
  std::vector<OptimiseEvaluation> evaluations;  ///< computed ones, in order
  long repeated = 0;                            ///< points that were asked for again and not computed
  long failed = 0;                              ///< evaluations that failed
  std::string stopped;                          ///< why the search ended
};

/// Points that the search is about to ask for, each once, in its order, none of them known. Within a generation no
/// point depends on the value of another: they can be computed at once.
using Ahead = std::function<void(const std::vector<std::vector<double>>& points)>;

/// The value to minimise. A point fails when InputError or SolverError is thrown (the scene or the response is not
/// possible there) or the value is not finite. It then counts as worse than any other. Other exceptions end the search.
using Objective = std::function<double(const std::vector<double>& x)>;

/// Smallest value within the bounds. All state is local: searches may run on several threads, each with its own
/// objective.
///
/// The points depend on variables, options and earlier values alone. A search is therefore resumed by repeating it with
/// an objective that takes known points from a store. `progress` (may be empty) is called after every generation.
/// `ahead` (may be empty) is called before every generation.
///
/// Throws InputError for unusable variables or options, SolverError when every point failed.
[[nodiscard]] OptimiseResult optimise(const std::vector<OptimiseVariable>& variables, const Objective& objective,
                                      const OptimiseOptions& options,
                                      const std::function<void(const OptimiseGeneration&)>& progress = {},
                                      const Ahead& ahead = {});

/// Evaluations (computed, failed ones included) until a value of at most `value` + `tolerance` was met; absent: never.
[[nodiscard]] std::optional<long> evaluations_to_reach(const std::vector<OptimiseEvaluation>& evaluations, double value,
                                                       double tolerance);

/// Range of the objective over all points that were tried.
struct ObjectiveRange {
  double low = 0, high = 0;
  double least_meaning = 0;  ///< the difference below which values are equal within their error
  long evaluations = 0;      ///< without failed ones
  /// high - low <= least_meaning: no point is better than another, whatever the search returns.
  bool flat = false;
  std::string verdict;  ///< a sentence with these numbers
};
/// `numerical_error`: absolute error of the objective; at least 1e-6 of its size is taken. Throws InputError when it is
/// negative.
[[nodiscard]] ObjectiveRange objective_range(const std::vector<OptimiseEvaluation>& evaluations,
                                             double numerical_error = 0);

}  // namespace annulus::dynamics
