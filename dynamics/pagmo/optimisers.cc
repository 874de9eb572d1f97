#include "dynamics/optimisation/optimisers.h"

#include <algorithm>
#include <cmath>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <utility>
#include <variant>

namespace annulus::dynamics {

namespace {

/// What pagmo copies about: a reference to the one objective.
struct UnitCubeProblem {
  const UnitObjective* objective = nullptr;
  std::size_t variables = 1;
  [[nodiscard]] pagmo::vector_double fitness(const pagmo::vector_double& unit) const { return {(*objective)(unit)}; }
  [[nodiscard]] std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(variables, 0.0), pagmo::vector_double(variables, 1.0)};
  }
};

using Method = std::variant<pagmo::sga, pagmo::cmaes, pagmo::de>;

/// One generation at a time, so that the population can be looked at after each; the methods go on where they were.
Method make_method(const OptimiseOptions& o, unsigned seed) {
  constexpr unsigned one_generation = 1;
  switch (o.optimiser) {
    case Optimiser::genetic: {
      const auto parents = static_cast<unsigned>(std::max(1L, std::lround(o.elite * o.population)));
      // Distribution indices as usual for real-coded genetic algorithms (Deb): children near their parents.
      constexpr double crossover_index = 10, mutation_index = 20;
      return pagmo::sga(one_generation, o.crossover, crossover_index, o.mutation, mutation_index, parents, "sbx",
                        "polynomial", "truncated", seed);
    }
    case Optimiser::cma_es: {
      constexpr double by_size = -1;  // learning rates of [Hansen2006]
      constexpr double width = 0.3;   // of the unit cube: what [Hansen2006] recommends for a known range
      constexpr double collapsed = 1e-15;
      return pagmo::cmaes(one_generation, by_size, by_size, by_size, by_size, width, collapsed, collapsed, true, true,
                          seed);
    }
    case Optimiser::differential_evolution:
      break;
  }
  constexpr double weight = 0.8, crossover = 0.9;
  constexpr unsigned rand_1_exp = 2;
  return pagmo::de(one_generation, weight, crossover, rand_1_exp, 0, 0, seed);
}

pagmo::population first_population(const OptimiseOptions& options, const OptimiserSeeds& seeds, std::size_t variables,
                                   const UnitObjective& objective) {
  return pagmo::population(pagmo::problem(UnitCubeProblem{&objective, variables}),
                           static_cast<std::size_t>(options.population), seeds.population);
}

class PagmoPopulation : public Population {
 public:
  PagmoPopulation(const OptimiseOptions& options, const OptimiserSeeds& seeds, std::size_t variables,
                  UnitObjective objective)
      : objective_(std::move(objective)),
        method_(make_method(options, seeds.method)),
        population_(first_population(options, seeds, variables, asked_)) {}

  void evolve() override { population_ = evolved(method_, std::move(population_)); }
  [[nodiscard]] std::vector<std::vector<double>> next_points() const override {
    std::vector<std::vector<double>> points;
    points_ = &points;
    // Copies: their state of chance goes on, that of this population stays.
    (void)evolved(Method(method_), pagmo::population(population_));
    points_ = nullptr;
    return points;
  }
  [[nodiscard]] std::vector<double> values() const override {
    std::vector<double> values;
    for (const auto& value : population_.get_f()) values.push_back(value[0]);
    return values;
  }

 private:
  static pagmo::population evolved(const Method& method, pagmo::population population) {
    return std::visit([&](const auto& m) { return m.evolve(std::move(population)); }, method);
  }

  UnitObjective objective_;
  mutable std::vector<std::vector<double>>* points_ = nullptr;  ///< where the points go that are only to be named
  UnitObjective asked_ = [this](const std::vector<double>& unit) {
    if (points_ == nullptr) return objective_(unit);
    points_->push_back(unit);
    return 0.0;
  };
  Method method_;
  pagmo::population population_;
};

std::unique_ptr<Population> start(const OptimiseOptions& options, const OptimiserSeeds& seeds, std::size_t variables,
                                  UnitObjective objective) {
  return std::make_unique<PagmoPopulation>(options, seeds, variables, std::move(objective));
}

std::vector<std::vector<double>> first_points(const OptimiseOptions& options, const OptimiserSeeds& seeds,
                                              std::size_t variables) {
  std::vector<std::vector<double>> points;
  const UnitObjective name = [&](const std::vector<double>& unit) {
    points.push_back(unit);
    return 0.0;
  };
  (void)first_population(options, seeds, variables, name);
  return points;
}

}  // namespace

}  // namespace annulus::dynamics

/// What core/loaded_library.h looks up.
extern "C" const annulus::dynamics::Optimisers annulus_optimisers_table;
const annulus::dynamics::Optimisers annulus_optimisers_table = {annulus::dynamics::start,
                                                                annulus::dynamics::first_points};
