#include "dynamics/optimisation/optimise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <random>
#include <utility>
#include <variant>

#include "core/errors.h"
#include "dynamics/optimisation/optimise_log.h"

namespace annulus::dynamics {

namespace {

/// What pagmo copies about: a reference to the one log.
struct UnitCubeProblem {
  OptimiseLog* log = nullptr;
  [[nodiscard]] pagmo::vector_double fitness(const pagmo::vector_double& unit) const { return {log->evaluate(unit)}; }
  [[nodiscard]] std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    const std::size_t n = log ? log->variables() : 1;
    return {pagmo::vector_double(n, 0.0), pagmo::vector_double(n, 1.0)};
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
      constexpr double by_size = -1;  // learning rates after Hansen
      constexpr double width = 0.3;   // of the unit cube: what Hansen recommends for a known range
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
  if (o.stop_spread && !(*o.stop_spread >= 0))
    throw InputError(fmt::format("the spread {} to stop at must not be negative", *o.stop_spread));
  if (!(o.stop_size >= 0)) throw InputError(fmt::format("the size {} to stop at must not be negative", o.stop_size));
}

double spread_of(const pagmo::population& population) {
  const auto [low, high] = std::minmax_element(population.get_f().begin(), population.get_f().end());
  return (*high)[0] - (*low)[0];
}

/// Largest extent of the population in the unit cube.
double size_of(const pagmo::population& population) {
  double size = 0;
  const auto& x = population.get_x();
  for (std::size_t i = 0; i < x.front().size(); ++i) {
    double low = 1, high = 0;
    for (const auto& point : x) {
      low = std::min(low, point[i]);
      high = std::max(high, point[i]);
    }
    size = std::max(size, high - low);
  }
  return size;
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
                        const OptimiseOptions& options,
                        const std::function<void(const OptimiseGeneration&)>& progress) {
  check(variables, options);
  OptimiseLog log(variables, objective);
  OptimiseResult result;
  result.optimiser = options.optimiser;
  // The same first population for every optimiser of one seed.
  std::seed_seq seeds{static_cast<std::uint32_t>(options.seed), static_cast<std::uint32_t>(options.seed >> 32)};
  unsigned drawn[2];
  seeds.generate(drawn, drawn + 2);
  Method method = make_method(options, drawn[1]);
  pagmo::population population(pagmo::problem(UnitCubeProblem{&log}), static_cast<std::size_t>(options.population),
                               drawn[0]);
  const auto note = [&](int generation) {
    result.history.push_back(log.generation(generation, population.get_f()));
    if (progress) progress(result.history.back());
  };
  note(0);
  result.stopped = fmt::format("all {} generations", options.generations);
  constexpr int patience = 5;
  int flat = 0;
  for (int generation = 1; generation <= options.generations; ++generation) {
    const long asked = log.asked();
    population = std::visit([&](const auto& m) { return m.evolve(std::move(population)); }, method);
    if (log.asked() == asked) {
      result.stopped = fmt::format("the optimiser had nothing left to try in generation {}", generation);
      break;
    }
    note(generation);
    flat = options.stop_spread && spread_of(population) <= *options.stop_spread ? flat + 1 : 0;
    if (flat == patience) {
      result.stopped = fmt::format("{} generations differed by no more than {:g}", patience, *options.stop_spread);
      break;
    }
    if (size_of(population) < options.stop_size) {
      result.stopped = fmt::format("the population is smaller than {:g} of the ranges", options.stop_size);
      break;
    }
  }
  if (!log.best()) throw SolverError("every point of the optimisation failed, the first: " + log.first_trouble());
  log.move_to(result);
  return result;
}

}  // namespace annulus::dynamics
