#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace annulus::dynamics {

/// What an optimiser may change.
struct OptimiseVariable {
  std::string name;
  double low = 0, high = 0;
  bool logarithmic = false;  ///< searched on the scale of the logarithm (low > 0)
  /// Whole numbers low ... high, equally likely; points that round to the same numbers are one evaluation.
  bool whole = false;
};

enum class Optimiser {
  genetic,                ///< pagmo::sga: truncated selection, simulated binary crossover, polynomial mutation, elitism
  cma_es,                 ///< pagmo::cmaes: Hansen, covariance matrix adaptation, within the bounds
  differential_evolution  ///< pagmo::de: rand/1/exp, Storn and Price
};
[[nodiscard]] const char* to_text(Optimiser optimiser);

/// Defaults of `generations`, `elite`, `crossover`, `mutation`: Wang et al. (2016), whose binary genetic algorithm is
/// met by a real-coded one: `elite` is the share of the population that alone is selected as parents (pagmo's
/// "truncated" selection takes turns among them); parents and children together compete for the next generation, so
/// the best is never lost; a pair is crossed with probability `crossover`, a gene mutates with probability `mutation`.
/// The paper does not print its population.
struct OptimiseOptions {
  Optimiser optimiser = Optimiser::genetic;
  int generations = 200;  ///< after the first population
  int population = 20;    ///< at least 5 (differential evolution, CMA-ES), even (genetic)
  std::uint64_t seed = 1;
  // genetic only
  double elite = 0.2;      ///< in (0, 1]
  double crossover = 0.9;  ///< in [0, 1]
  double mutation = 0.05;  ///< in [0, 1]
  /// Stops once best and worst of a population without failures differ by no more than this for five generations
  /// running: the numerical error of the objective, below which differences mean nothing. Absent: never.
  std::optional<double> stop_spread{};
  /// Stops once all points of a population lie closer than this share of the range of every variable. 0: never.
  double stop_size = 0;
};

/// One point that was computed.
struct OptimiseEvaluation {
  std::vector<double> x;
  double value = std::numeric_limits<double>::quiet_NaN();  ///< not a number: failed
  std::string trouble;                                      ///< why it failed, empty otherwise
};

/// State of the population after a generation; 0 is the first population. Failed points do not count in the figures.
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
  long repeated = 0;                            ///< points that came again and were answered without computing
  long failed = 0;                              ///< evaluations that failed
  std::string stopped;                          ///< why the search ended
};

/// The value to make small. A point fails by throwing InputError or SolverError (the scene or the response is not
/// possible there) or by a value that is not finite; it then counts as worse than any other. Other exceptions end the
/// search.
using Objective = std::function<double(const std::vector<double>& x)>;

/// Smallest value within the bounds. All state is local: searches may run side by side on several threads, each with
/// its own objective. The points asked for depend on variables, options and earlier values alone, so that a search is
/// resumed by repeating it with an objective that answers known points from a store. `progress` (may be empty) is
/// called after every generation.
/// Throws InputError naming what is wrong with variables or options, SolverError when every point failed.
[[nodiscard]] OptimiseResult optimise(const std::vector<OptimiseVariable>& variables, const Objective& objective,
                                      const OptimiseOptions& options,
                                      const std::function<void(const OptimiseGeneration&)>& progress = {});

/// Evaluations (computed, failed ones included) until a value of at most `value` + `tolerance` was met; absent: never.
[[nodiscard]] std::optional<long> evaluations_to_reach(const std::vector<OptimiseEvaluation>& evaluations, double value,
                                                       double tolerance);

/// How much the objective moves over everything that was tried.
struct ObjectiveRange {
  double low = 0, high = 0;
  double least_meaning = 0;  ///< the difference below which values say nothing
  long evaluations = 0;      ///< without failed ones
  /// high - low <= least_meaning: no best point can be told, whatever the search says.
  bool flat = false;
  std::string verdict;  ///< a sentence with the figures
};
/// `numerical_error`: of the objective, absolute; at least 1e-6 of its size counts.
[[nodiscard]] ObjectiveRange objective_range(const std::vector<OptimiseEvaluation>& evaluations,
                                             double numerical_error = 0);

}  // namespace annulus::dynamics
