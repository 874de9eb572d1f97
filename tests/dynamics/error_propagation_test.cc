#include "dynamics/error_propagation/error_propagation.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace annulus {

namespace {

using namespace dynamics;

constexpr double stiffness = 1e9, mass = 5;  // N/m, kg

/// k (1 + ripple cos) with one relative error everywhere.
StiffnessTable table_of(int phases, double error, double ripple) {
  std::vector<StiffnessEntry> entries;
  for (int i = 0; i < phases; ++i) {
    const double k = stiffness * (1 + ripple * std::cos(2 * std::numbers::pi * i / phases));
    entries.push_back(
        {.unloaded_te = 0, .lte = 1e4 / k, .stiffness_secant = k, .stiffness_tangent = k, .error_relative = error});
  }
  return {"sun_planet", phases, {0.0}, {1e4}, std::move(entries)};
}

double mean_of(const StiffnessTable& table) {
  double sum = 0;
  for (int i = 0; i < table.phases(); ++i) sum += table.at(0, i, 0).stiffness_secant;
  return sum / table.phases();
}

/// A mass on two meshes side by side: its frequency is known in closed form.
Evaluation frequency_of(const std::vector<StiffnessTable>& tables) {
  double k = 0;
  for (const auto& table : tables) k += mean_of(table);
  Evaluation result;
  result.figures.set("frequency_1_Hz", Figure{std::sqrt(k / mass) / (2 * std::numbers::pi), 0.25});
  result.figures.set("constant", Figure{7, 0});
  return result;
}

TabulatedModel model_of(std::vector<TabulatedMesh> meshes) {
  return {.meshes = std::move(meshes), .evaluate = frequency_of, .seeks_steady_state = false};
}

std::vector<StiffnessTable> tables_of(const TabulatedModel& model) {
  std::vector<StiffnessTable> tables;
  for (const auto& mesh : model.meshes) tables.push_back(mesh.table);
  return tables;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(error_propagation)

BOOST_AUTO_TEST_CASE(a_frequency_follows_the_errors_of_its_stiffness) {
  // f ~ sqrt(k_1 + k_2): one mesh of two equal ones stiffer by e raises it by sqrt(1 + e / 2) - 1.
  const double first = 0.02, second = 0.01;
  const auto model = model_of({{"sun mesh", table_of(8, first, 0), {.discretisation = 0.003, .model = 0.001}},
                               {"ring mesh", table_of(8, second, 0), {}}});
  const auto nominal = frequency_of(tables_of(model));
  const auto found = propagate_errors(nominal, model);
  const double f = nominal.figures.value("frequency_1_Hz");
  const double by_first = f * (std::sqrt(1 + first / 2) - 1), by_second = f * (std::sqrt(1 + second / 2) - 1);
  const auto& parts = found.find("frequency_1_Hz")->parts;
  const auto close = boost::test_tools::tolerance(1e-12);  // rounding of the tables
  // The first in the proportions of its own error, the second, whose causes are not known, as discretisation.
  BOOST_TEST(parts.discretisation == 0.75 * by_first + by_second, close);
  BOOST_TEST(parts.model == 0.25 * by_first, close);
  BOOST_TEST(parts.integration == 0.25);
  BOOST_TEST(parts.interpolation == 0.0);
  BOOST_TEST(found.figure("frequency_1_Hz").error == parts.total(), close);
  BOOST_TEST(found.value("frequency_1_Hz") == f);
  BOOST_TEST(found.figure("constant").error == 0.0);
}

BOOST_AUTO_TEST_CASE(half_the_phases_state_the_interpolation) {
  // Phases 0 and pi of a cosine alone have the same mean as all; means over one phase are k (1 +- ripple).
  const double ripple = 0.1;
  constexpr double resolved = 1;  // teeth take up their load within more than the distance of two phases
  const auto model = model_of({{"mesh", table_of(2, 0, ripple), {}, resolved}});
  const auto nominal = frequency_of(tables_of(model));
  const auto found = propagate_errors(nominal, model);
  const double f = nominal.figures.value("frequency_1_Hz");
  BOOST_TEST(found.find("frequency_1_Hz")->parts.interpolation == f * (1 - std::sqrt(1 - ripple)),
             boost::test_tools::tolerance(1e-9));
  // Either two of four phases have the mean of all again; a quarter of them, the first, has not.
  const auto four = model_of({{"mesh", table_of(4, 0, ripple), {}, resolved}});
  BOOST_TEST(propagate_errors(frequency_of(tables_of(four)), four).find("frequency_1_Hz")->parts.interpolation ==
                 f * (std::sqrt(1 + ripple) - 1) / 4,
             boost::test_tools::tolerance(1e-9));
  const auto odd = model_of({{"mesh", table_of(5, 0, ripple), {}}});
  const auto unknown = propagate_errors(frequency_of(tables_of(odd)), odd);
  BOOST_TEST(std::isnan(unknown.find("frequency_1_Hz")->parts.interpolation));
  BOOST_TEST(std::isnan(unknown.figure("frequency_1_Hz").error));
}

BOOST_AUTO_TEST_CASE(models_without_a_solution_have_errors_that_are_not_known) {
  auto model = model_of({{"mesh", table_of(8, 0.01, 0), {}}});
  const auto nominal = frequency_of(tables_of(model));
  model.evaluate = [](const std::vector<StiffnessTable>&) -> Evaluation { throw SolverError("no steady state"); };
  model.nominal_alike = true;
  const auto found = propagate_errors(nominal, model);
  BOOST_TEST(std::isnan(found.figure("frequency_1_Hz").error));
  BOOST_TEST(found.value("frequency_1_Hz") == nominal.figures.value("frequency_1_Hz"));
}

BOOST_AUTO_TEST_CASE(unchanged_tables_without_a_solution_are_tried_once) {
  auto model = model_of({{"sun mesh", table_of(8, 0.01, 0), {}}, {"ring mesh", table_of(8, 0.01, 0), {}}});
  const auto nominal = frequency_of(tables_of(model));
  int calls = 0;
  model.evaluate = [&calls](const std::vector<StiffnessTable>&) -> Evaluation {
    ++calls;
    throw SolverError("no steady state");
  };
  const auto found = propagate_errors(nominal, model);
  BOOST_TEST(calls == 1);
  BOOST_TEST(std::isnan(found.figure("frequency_1_Hz").error));
}

BOOST_AUTO_TEST_CASE(changed_tables_are_solved_as_the_nominal_motion_was_found) {
  SimulationOptions options;
  SteadyOutcome nominal;
  nominal.periodic.emplace();
  nominal.periodic->converged = true;
  nominal.steady = true;
  nominal.window_cycles = 7;
  options.samples_per_cycle = enough_samples(nominal.window_cycles);
  // The harmonic balance alone was the answer.
  const auto balance = comparison_options(nominal, options);
  BOOST_TEST((balance.simulation.confirmation == Confirmation::never));
  BOOST_TEST(balance.seeks_steady_state);
  BOOST_TEST(balance.nominal_alike);
  // Time integration led elsewhere: integrated from there, for a few windows.
  nominal.total_cycles = 500;
  const auto integrated = comparison_options(nominal, options);
  BOOST_TEST((integrated.simulation.steady_state == SteadyState::time_integration));
  BOOST_TEST(integrated.simulation.max_windows <= 8);
  BOOST_TEST(integrated.seeks_steady_state);
  // No steady state: all for the same time, which the nominal motion was not.
  nominal.steady = false;
  const auto unsteady = comparison_options(nominal, options);
  BOOST_TEST(unsteady.simulation.mesh_cycles.value() == 170);
  BOOST_TEST(!unsteady.seeks_steady_state);
  BOOST_TEST(!unsteady.nominal_alike);
}

BOOST_AUTO_TEST_CASE(frequencies_that_may_change_places_share_their_errors) {
  // One frequency follows the mesh, the other does not and is 1 % lower: either may be the first.
  const double relative = 0.08;
  auto model = model_of({{"mesh", table_of(8, relative, 0), {}, 1}});
  model.evaluate = [](const std::vector<StiffnessTable>& tables) {
    const double of_mesh = std::sqrt(mean_of(tables.front()) / stiffness), still = 0.99;
    Evaluation result;
    result.figures.set("frequency_1_Hz", Figure{std::min(of_mesh, still), 0});
    result.figures.set("frequency_2_Hz", Figure{std::max(of_mesh, still), 0});
    return result;
  };
  const auto found = propagate_errors(model.evaluate(tables_of(model)), model);
  const auto close = boost::test_tools::tolerance(1e-12);
  const double error = std::sqrt(1 + relative) - 1;
  BOOST_TEST(found.figure("frequency_2_Hz").error == error, close);
  BOOST_TEST(found.figure("frequency_1_Hz").error == 0.99 - (1 - error), close);
  BOOST_TEST(found.find("frequency_1_Hz")->parts.total() == found.figure("frequency_1_Hz").error, close);
}

BOOST_AUTO_TEST_CASE(prescribed_stiffness_is_exact) {
  const auto model = model_of({});
  Evaluation nominal;
  nominal.figures.set("frequency_1_Hz", Figure{100, 0.25});
  const auto found = propagate_errors(nominal, model);
  BOOST_TEST(found.figure("frequency_1_Hz").error == 0.25);
  BOOST_TEST(found.find("frequency_1_Hz")->parts.integration == 0.25);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
