#include "tests/random/relations.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>

namespace annulus::test {

using namespace annulus::random;

namespace {

const Relation& relation(const std::string& name) {
  return *std::find_if(random::relations().begin(), random::relations().end(),
                       [&](const Relation& r) { return r.name == name; });
}

SceneRun run_with(const std::vector<StatedResult>& results) {
  SceneRun run;
  run.outcome = Outcome::right;
  run.results = results;
  return run;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(relations)

BOOST_AUTO_TEST_CASE(results_differ_by_more_than_their_errors_without_the_models) {
  const StatedResult first{.variant = "", .key = "k", .value = 10, .error = 0.5, .model_error = 0.4};
  const StatedResult second{.variant = "", .key = "k", .value = 10.3, .error = 0.2, .model_error = 0.1};
  const auto list = compared(relation("two accuracies"), run_with({first}), run_with({second}));
  BOOST_REQUIRE(list.size() == 1);
  BOOST_TEST(list.front().effectivity() == 1.5, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(!list.front().agrees());
  const auto all = compared(relation("two models"), run_with({first}), run_with({second}));
  BOOST_TEST(all.front().effectivity() == 0.3 / 0.7, boost::test_tools::tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(results_of_twice_the_size_scale_with_their_unit) {
  const auto& size = relation("twice the size");
  const auto first = run_with({{.variant = "", .key = "sun_planet_mean_stiffness_N_per_m", .value = 1e9, .error = 1e7},
                               {.variant = "", .key = "frequency_1_Hz", .value = 100, .error = 1},
                               {.variant = "", .key = "dynamic_factor", .value = 1.2, .error = 0.1}});
  auto second = run_with({{.variant = "", .key = "sun_planet_mean_stiffness_N_per_m", .value = 2e9, .error = 1e7},
                          {.variant = "", .key = "frequency_1_Hz", .value = 50, .error = 1},
                          {.variant = "", .key = "dynamic_factor", .value = 1.2, .error = 0.1}});
  for (const auto& result : compared(size, first, second)) BOOST_TEST(result.agrees(), result.key);
  second.results[1].value = 50.1;
  BOOST_TEST(!compared(size, first, second)[1].agrees());
}

BOOST_AUTO_TEST_CASE(a_component_of_no_size_rounds_as_the_others) {
  const auto run = [](double axial, double rotation) {
    return run_with({{.variant = "", .key = "acceleration_axial_m_per_s2", .value = axial, .error = 0},
                     {.variant = "", .key = "acceleration_rotation_m_per_s2", .value = rotation, .error = 0}});
  };
  const auto& threads = relation("two threads");
  const auto& stiffer = relation("material four times as stiff");
  BOOST_TEST(compared(stiffer, run(1e-16, 100), run(3e-15, 100)).front().agrees());
  BOOST_TEST(!compared(stiffer, run(1e-16, 100), run(1e-3, 100)).front().agrees());
  BOOST_TEST(!compared(threads, run(1e-16, 100), run(3e-15, 100)).front().agrees());
}

BOOST_AUTO_TEST_CASE(missing_results_and_results_without_errors_are_no_evidence) {
  const auto first = run_with({{.variant = "", .key = "a", .value = 1, .error = not_known},
                               {.variant = "", .key = "b", .value = 1, .error = 0.1}});
  const auto second = run_with({{.variant = "", .key = "a", .value = 2, .error = 0.1}});
  BOOST_TEST(compared(relation("two accuracies"), first, second).empty());
}

BOOST_AUTO_TEST_CASE(pairs_change_what_they_say) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto scene = random::random_scene(seed);
    for (const auto& r : random::relations()) {
      const auto pair = r.pair(scene);
      if (!pair) continue;
      const bool same_scene = r.agreement == Agreement::identical;
      BOOST_TEST((pair->first == pair->second) == same_scene, r.name << " of seed " << seed);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::test
