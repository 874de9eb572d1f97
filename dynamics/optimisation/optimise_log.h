#pragma once

#include <map>

#include "dynamics/optimisation/optimise.h"

namespace annulus::dynamics {

/// The objective for an optimiser: a finite function on the unit cube that computes no point twice and stores all.
class OptimiseLog {
 public:
  OptimiseLog(const std::vector<OptimiseVariable>& variables, const Objective& objective)
      : variables_(variables), objective_(objective) {}

  /// Value of a failed point: worse than any value met, now or later.
  static constexpr double penalty = 1e300;

  [[nodiscard]] double evaluate(const std::vector<double>& unit);
  [[nodiscard]] std::vector<double> point(const std::vector<double>& unit) const;
  [[nodiscard]] std::size_t variables() const { return variables_.size(); }
  [[nodiscard]] long asked() const { return static_cast<long>(evaluations_.size()) + repeated_; }
  [[nodiscard]] const OptimiseEvaluation* best() const;
  [[nodiscard]] OptimiseGeneration generation(int number, const std::vector<std::vector<double>>& values) const;
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

}  // namespace annulus::dynamics
