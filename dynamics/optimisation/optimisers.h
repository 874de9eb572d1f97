#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "dynamics/optimisation/optimise.h"

namespace annulus::dynamics {

/// Points of the unit cube with their values, on the way to smaller ones.
class Population {
 public:
  Population() = default;
  virtual ~Population() = default;
  Population(const Population&) = delete;
  Population& operator=(const Population&) = delete;

  /// The next generation.
  virtual void evolve() = 0;
  /// The points for which evolve() will ask, in this order.
  [[nodiscard]] virtual std::vector<std::vector<double>> next_points() const = 0;
  /// Of all its points.
  [[nodiscard]] virtual std::vector<double> values() const = 0;
};

/// A finite function on the unit cube, to minimise.
using UnitObjective = std::function<double(const std::vector<double>& unit)>;

/// Of the first population and of the method.
struct OptimiserSeeds {
  unsigned population = 0, method = 0;
};

/// What annulus lets pagmo do, in a library of its own that is loaded when it is needed.
struct Optimisers {
  /// Draws the first population and evaluates it. `options` have been checked.
  std::unique_ptr<Population> (*start)(const OptimiseOptions& options, const OptimiserSeeds& seeds,
                                       std::size_t variables, UnitObjective objective);
  /// The points for which start() will ask.
  std::vector<std::vector<double>> (*first_points)(const OptimiseOptions& options, const OptimiserSeeds& seeds,
                                                   std::size_t variables);
};

}  // namespace annulus::dynamics
