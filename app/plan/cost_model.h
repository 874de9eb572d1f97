#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/plan/cost_run.h"

namespace annulus::app {

/// What a step is predicted to cost.
struct PredictedCost {
  double seconds = 0;  ///< wall
  double peak_MB = 0;  ///< of the whole process
};

/// Laws of one kind of step. With N the unknowns of a level in ten thousands:
///
///     bodies    a sum_levels N^b / speed-up                               s
///     contact   (sum_levels N^c (first_ms first + each_ms all) + support_ms (S / 100)^2 all) / speed-up
///               ms, `first` and `all` being contact problems, S the forces of supports in each of them
///     peak      base_MB + per_unknown_MB N (bodies at once)               MB, N of the last level
///     error     first ratio^(level - 1)                           by degree of the elements
///
/// A speed-up on t threads is 1 + efficiency (t - 1), at most as many threads as there are tasks. So is the memory that
/// two bodies take which are condensed at once.
struct CostLaw {
  double body = 0, body_exponent = 1, body_efficiency = 0;
  double first_ms = 0, each_ms = 0, contact_exponent = 0, contact_efficiency = 0;
  double support_ms = 0;
  double base_MB = 0, per_unknown_MB = 0, memory_overlap = 0;
  struct Error {
    double first = 0, ratio = 1;
  };
  std::map<int, Error> error{};  ///< estimated, by degree
};

/// Time and memory of the steps of a run, from measured ones. The laws are fitted to their logarithms by least squares;
/// where few runs were measured, exponents stay near what such solves usually take.
class CostModel {
 public:
  /// `own`: measured on this machine; from the third of a kind on, the median of measured to predicted time scales the
  /// predictions of that kind.
  explicit CostModel(const std::vector<CostRun>& kept, const std::vector<CostRun>& own = {});
  /// From the kept runs and the user's file.
  [[nodiscard]] static CostModel of_this_machine();

  [[nodiscard]] PredictedCost predict(const CostRun& size) const;
  /// Estimated relative error of a model's table at a level with elements of a degree (that of quadratic ones where
  /// nothing is known of the degree); NaN where nothing is known.
  [[nodiscard]] double expected_error(const std::string& kind, int degree, int level) const;
  /// Level at which refining until `accuracy` is met will end.
  [[nodiscard]] int expected_level(const std::string& kind, int degree, double accuracy, int last_level) const;
  /// Of a kind by the user's own runs; 1 without.
  [[nodiscard]] double scale(const std::string& kind) const;
  [[nodiscard]] const CostLaw& law(const std::string& kind) const;

 private:
  std::map<std::string, CostLaw> laws_;
  std::map<std::string, double> scales_;
};

}  // namespace annulus::app
