#include "dynamics/optimisation/optimise.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <set>
#include <thread>

#include "core/errors.h"
#include "dynamics/systems/planetary/study_point.h"
#include "stages.h"

using namespace annulus;
using namespace annulus::dynamics;

namespace {

double square(double x) { return x * x; }
double sphere(const std::vector<double>& x) { return square(x[0] - 0.3) + square(x[1] + 1.2); }
double rosenbrock(const std::vector<double>& x) { return square(1 - x[0]) + 100 * square(x[1] - square(x[0])); }

const std::vector<OptimiseVariable> plane{{"a", -2, 2}, {"b", -3, 3}};
constexpr Optimiser all[] = {Optimiser::genetic, Optimiser::cma_es, Optimiser::differential_evolution};

OptimiseResult search(Optimiser optimiser, const Objective& objective, std::uint64_t seed = 1, int generations = 200) {
  OptimiseOptions options;
  options.optimiser = optimiser;
  options.seed = seed;
  options.generations = generations;
  return optimise(plane, objective, options);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(optimise_search)

BOOST_AUTO_TEST_CASE(all_optimisers_find_the_minimum_of_a_sphere_within_the_bounds) {
  for (const auto optimiser : all) {
    bool inside = true;
    const auto result = search(optimiser, [&](const auto& x) {
      inside = inside && std::abs(x[0]) <= 2 && std::abs(x[1]) <= 3;
      return sphere(x);
    });
    // The genetic algorithm mutates ever more finely but never settles; the others converge linearly.
    BOOST_TEST(result.value < (optimiser == Optimiser::genetic ? 1e-4 : 1e-10), to_text(optimiser));
    BOOST_TEST(std::abs(result.x[0] - 0.3) < 0.02);
    BOOST_TEST(std::abs(result.x[1] + 1.2) < 0.02);
    BOOST_TEST(inside);
    BOOST_TEST(result.value == sphere(result.x));
  }
}

BOOST_AUTO_TEST_CASE(cma_es_and_differential_evolution_follow_rosenbrocks_valley) {
  for (const auto optimiser : {Optimiser::cma_es, Optimiser::differential_evolution}) {
    const auto result = search(optimiser, rosenbrock);
    BOOST_TEST(result.value < 1e-6, to_text(optimiser));
    BOOST_TEST(std::abs(result.x[0] - 1) < 1e-2);
  }
  // Both reach what the genetic algorithm reaches at its best; it is slow along the valley.
  BOOST_TEST(search(Optimiser::genetic, rosenbrock).value < 1);
}

BOOST_AUTO_TEST_CASE(history_is_monotone_and_counts) {
  for (const auto optimiser : all) {
    long calls = 0;
    const auto r = search(optimiser, [&](const auto& x) {
      ++calls;
      return sphere(x);
    });
    BOOST_TEST(r.history.size() >= 2u);
    BOOST_TEST(calls == static_cast<long>(r.evaluations.size()));
    BOOST_TEST(r.history.back().evaluations == calls);
    BOOST_TEST(r.history.front().evaluations == 20);
    BOOST_TEST(r.history.back().best == r.value);
    for (std::size_t i = 1; i < r.history.size(); ++i) {
      BOOST_TEST(r.history[i].best <= r.history[i - 1].best);
      BOOST_TEST(r.history[i].evaluations >= r.history[i - 1].evaluations);
      BOOST_TEST(r.history[i].mean <= r.history[i].worst * (1 + 1e-12));
      BOOST_TEST(r.history[i].mean >= r.history[i].best * (1 - 1e-12));  // rounding of the mean of equal values
    }
    std::set<std::vector<double>> points;
    for (const auto& e : r.evaluations) points.insert(e.x);
    BOOST_TEST(points.size() == r.evaluations.size());  // no point twice
  }
}

BOOST_AUTO_TEST_CASE(a_seed_gives_one_search_on_any_thread_and_another_seed_another) {
  for (const auto optimiser : all) {
    const auto a = search(optimiser, sphere, 7, 30), other = search(optimiser, sphere, 8, 30);
    OptimiseResult b, c;
    std::thread first([&] { b = search(optimiser, sphere, 7, 30); });
    std::thread second([&] { c = search(optimiser, rosenbrock, 7, 30); });
    first.join();
    second.join();
    BOOST_REQUIRE(a.evaluations.size() == b.evaluations.size());
    for (std::size_t i = 0; i < a.evaluations.size(); ++i) BOOST_TEST((a.evaluations[i].x == b.evaluations[i].x));
    BOOST_TEST((a.evaluations.front().x == c.evaluations.front().x));
    BOOST_TEST((a.evaluations.front().x != other.evaluations.front().x));
  }
}

BOOST_AUTO_TEST_CASE(whole_numbers_are_searched_without_computing_twice) {
  const std::vector<OptimiseVariable> pins{{"pins", 3, 12, false, true}, {"rows", 1, 4, false, true}};
  for (const auto optimiser : all) {
    OptimiseOptions options;
    options.optimiser = optimiser;
    options.generations = 40;
    const auto r = optimise(
        pins,
        [](const auto& x) {
          BOOST_TEST(x[0] == std::round(x[0]));
          return square(x[0] - 9) + square(x[1] - 2) + 0.5;
        },
        options);
    BOOST_TEST(r.value == 0.5);
    BOOST_TEST(r.evaluations.size() <= 40u);  // all there are
    BOOST_TEST(r.repeated > 100);
  }
}

BOOST_AUTO_TEST_CASE(logarithmic_variables_spend_equal_effort_on_every_decade) {
  const std::vector<OptimiseVariable> half{{"half backlash", 1e-5, 1e-3, true}};
  OptimiseOptions options;
  options.optimiser = Optimiser::cma_es;
  options.generations = 60;
  const auto r = optimise(
      half, [](const auto& x) { return square(std::log10(x[0]) + 4.5); }, options);
  BOOST_TEST(r.x[0] == std::pow(10, -4.5), boost::test_tools::tolerance(1e-3));
  options.optimiser = Optimiser::genetic;
  options.population = 1000;
  options.generations = 1;
  const auto many = optimise(
      half, [](const auto&) { return 1.0; }, options);
  long low = 0;
  for (int i = 0; i < 1000; ++i) low += many.evaluations[i].x[0] < 1e-4;
  BOOST_TEST(std::abs(low - 500) < 64);  // four standard deviations of a fair coin
}

BOOST_AUTO_TEST_CASE(a_failing_region_is_left_counted_and_reported) {
  const auto objective = [](const std::vector<double>& x) {
    if (x[0] > 0.5) throw InputError("no such stage");
    if (x[1] > 1) return std::numeric_limits<double>::quiet_NaN();
    return -x[0] - x[1] + 1e3;  // best at the edge of failure, values far above zero
  };
  for (const auto optimiser : all) {
    const auto r = search(optimiser, objective);
    BOOST_TEST(r.failed > 0);
    BOOST_TEST(r.x[0] <= 0.5);
    BOOST_TEST(r.value == 1e3 - 1.5, boost::test_tools::tolerance(1e-4));
    long failed = 0;
    for (const auto& e : r.evaluations) {
      BOOST_TEST(std::isnan(e.value) == !e.trouble.empty());
      failed += std::isnan(e.value);
    }
    BOOST_TEST(failed == r.failed);
    for (const auto& g : r.history) BOOST_TEST((!(g.worst > 2e3)));  // penalties are no values
  }
  BOOST_CHECK_THROW(search(
                        Optimiser::genetic, [](const auto&) -> double { throw SolverError("never"); }, 1, 2),
                    SolverError);
  // What is not a failed point ends the search.
  BOOST_CHECK_THROW(search(
                        Optimiser::genetic, [](const auto&) -> double { throw std::bad_alloc(); }, 1, 2),
                    std::bad_alloc);
}

BOOST_AUTO_TEST_CASE(a_flat_objective_is_called_flat) {
  const auto ripple = [](const std::vector<double>& x) { return 1.5 + 1e-9 * std::sin(1e4 * x[0]); };
  for (const auto optimiser : all) {
    OptimiseOptions options;
    options.optimiser = optimiser;
    options.generations = 5;
    const auto r = optimise(plane, ripple, options);
    const auto range = objective_range(r.evaluations);
    BOOST_TEST(range.flat);
    BOOST_TEST(range.verdict.find("flat") == 0u);
    BOOST_TEST(!objective_range(search(optimiser, sphere, 1, 10).evaluations, 1e-3).flat);
    BOOST_TEST(objective_range(search(optimiser, sphere, 1, 10).evaluations, 1e3).flat);
  }
}

BOOST_AUTO_TEST_CASE(optimisers_are_compared_by_evaluations_to_one_value) {
  const auto genetic = search(Optimiser::genetic, sphere), cma = search(Optimiser::cma_es, sphere);
  const auto a = evaluations_to_reach(genetic.evaluations, 0, 1e-3), b = evaluations_to_reach(cma.evaluations, 0, 1e-3);
  BOOST_REQUIRE((a && b));
  BOOST_TEST(genetic.evaluations[*a - 1].value <= 1e-3);
  for (long i = 0; i < *a - 1; ++i) BOOST_TEST(genetic.evaluations[i].value > 1e-3);
  BOOST_TEST(!evaluations_to_reach(cma.evaluations, -1, 0.5).has_value());
}

BOOST_AUTO_TEST_CASE(a_search_is_resumed_from_a_store) {
  std::map<std::vector<double>, double> store;
  for (const auto& e : search(Optimiser::cma_es, sphere, 3, 20).evaluations) store[e.x] = e.value;
  long computed = 0;
  const auto resumed = search(
      Optimiser::cma_es,
      [&](const auto& x) {
        const auto found = store.find(x);
        if (found != store.end()) return found->second;
        ++computed;
        return sphere(x);
      },
      3, 30);
  BOOST_TEST(computed == 200);  // the ten generations more
  BOOST_TEST(resumed.value == search(Optimiser::cma_es, sphere, 3, 30).value);
}

// All points of a generation are named before any of them is asked for, and no other one.
BOOST_AUTO_TEST_CASE(points_are_named_before_they_are_asked_for) {
  const std::vector<OptimiseVariable> mixed{{"a", -2, 2}, {"b", -3, 3, false, true}};
  const auto uneven = [](const std::vector<double>& x) {
    if (x[0] > 1.5) throw SolverError("beyond");
    return sphere(x);
  };
  for (const auto optimiser : all) {
    OptimiseOptions options;
    options.optimiser = optimiser;
    options.generations = 30;
    const auto plain = optimise(mixed, uneven, options);
    std::vector<std::vector<double>> named, asked;
    std::size_t batches = 0;
    const auto with_names = optimise(
        mixed,
        [&](const std::vector<double>& x) {
          asked.push_back(x);
          return uneven(x);
        },
        options, {},
        [&](const std::vector<std::vector<double>>& points) {
          BOOST_TEST((named == asked), to_text(optimiser) << ", generation " << batches);  // of all generations before
          named.insert(named.end(), points.begin(), points.end());
          ++batches;
        });
    BOOST_TEST((named == asked), to_text(optimiser));
    BOOST_TEST(batches > 20U);
    BOOST_TEST((with_names.x == plain.x));
    BOOST_REQUIRE(with_names.evaluations.size() == plain.evaluations.size());
    for (std::size_t i = 0; i < plain.evaluations.size(); ++i)
      BOOST_TEST((with_names.evaluations[i].x == plain.evaluations[i].x));
    BOOST_TEST(with_names.stopped == plain.stopped);
  }
}

BOOST_AUTO_TEST_CASE(wrong_variables_and_options_are_refused) {
  const auto refused = [](const std::vector<OptimiseVariable>& v, OptimiseOptions o) {
    try {
      (void)optimise(v, sphere, o);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  BOOST_TEST(refused({}, {}));
  BOOST_TEST(refused({{"a", 1, 1}}, {}));
  BOOST_TEST(refused({{"a", 0, 1, true}}, {}));
  BOOST_TEST(refused({{"a", 0.5, 3, false, true}}, {}));
  BOOST_TEST(refused(plane, {.population = 7}));
  BOOST_TEST(refused(plane, {.population = 4}));
  BOOST_TEST(refused(plane, {.elite = 0}));
  BOOST_TEST(refused(plane, {.mutation = 1.5}));
}

// The optimisation of the paper: without errors, at its speed, there is nothing to optimise.
BOOST_AUTO_TEST_CASE(load_sharing_of_the_backlash_paper_is_flat_over_both_backlashes) {
  const std::vector<OptimiseVariable> halves{{"sun", 1e-5, 1e-3}, {"ring", 1e-5, 1e-3}};
  OptimiseOptions options;
  options.generations = 4;
  const auto r = optimise(
      halves,
      [](const auto& x) {
        auto stage = stages::backlash_paper();
        stage.sun_half_backlash = x[0];
        stage.ring_half_backlash = x[1];
        const auto p = evaluate_point(stage, {.simulation = {}, .motion = false}).figures;
        return 0.5 *
               (p.value("sun_planet_load_sharing_instantaneous") + p.value("ring_planet_load_sharing_instantaneous"));
      },
      options);
  const auto range = objective_range(r.evaluations);
  BOOST_TEST(range.flat);
  BOOST_TEST(range.high - range.low <= 1e-10);
}

BOOST_AUTO_TEST_SUITE_END()
