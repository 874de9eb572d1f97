#include "app/process/held_limits.h"

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "core/files.h"
#include "tests/app/fault_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

namespace annulus {

BOOST_AUTO_TEST_SUITE(held_limits)

BOOST_AUTO_TEST_CASE(a_plan_states_what_quadratic_elements_would_cost) {
  const test::TemporaryFolder folder("worst_plan");
  write_file(folder.path() / "scene.toml", test::fault_scene("limits_not_held"));
  const auto planned = test::run_program(folder.path(), "plan scene.toml --json --threads 2");
  BOOST_TEST_REQUIRE(planned.status == 0, planned.err);
  const auto plan = nlohmann::json::parse(planned.out);
  const double likely = plan["predicted_peak_MB"], worst = plan["predicted_worst_peak_MB"];
  BOOST_TEST(worst > 1.5 * likely);
  BOOST_TEST(plan["predicted_worst_s"].get<double>() > 3 * plan["predicted_s"].get<double>());
  const auto text = test::run_program(folder.path(), "plan scene.toml").out;
  BOOST_TEST(text.find("if quadratic elements follow") != std::string::npos);
  BOOST_TEST(text.find("at worst") != std::string::npos);
  // Between both: today's linear elements would fit, those that follow would not.
  const auto limit = std::to_string(static_cast<int>((likely + worst) / 2)) + "MB";
  const auto refused = test::run_program(folder.path(), "run scene.toml -o out --threads 2 --max-memory " + limit);
  BOOST_TEST(refused.status == 3);
  BOOST_TEST(refused.err.find("if quadratic elements follow") != std::string::npos, refused.err);
  BOOST_TEST(refused.err.find(" (--max-memory)") != std::string::npos);
  BOOST_TEST(!std::filesystem::exists(folder.path() / "out"));
}

BOOST_AUTO_TEST_CASE(a_run_ends_at_its_limits_whatever_was_predicted) {
  const test::TemporaryFolder folder("held");
  write_file(folder.path() / "scene.toml", test::fault_scene("omitted_pair"));
  // A cost study solves the meshes many times, which the plan of a run does not predict.
  const auto late = test::run_program(folder.path(), "tradeoff scene.toml -o out --threads 1 --max-time 8s");
  BOOST_TEST(late.status == 4, late.err);
  BOOST_TEST(late.err.find("--max-time: ended during ") != std::string::npos, late.err);
  BOOST_TEST(late.err.find("the limit is 8 s") != std::string::npos, late.err);
  // Tables that the scene prescribes are predicted to need nothing.
  write_file(folder.path() / "scene.toml", test::quick_scene());
  const auto large = test::run_program(folder.path(), "solve scene.toml -o out --max-memory 1MB");
  BOOST_TEST(large.status == 4, large.err);
  BOOST_TEST(large.err.find("--max-memory: ended during the run: ") != std::string::npos, large.err);
  for (const auto* word : {"the limit is 1 MB", "finished results are stored in out/cache", "raise the limit"})
    BOOST_TEST(large.err.find(word) != std::string::npos, large.err);
  const auto done = test::run_program(folder.path(), "solve scene.toml -o out --max-time 1h --max-memory 100GB");
  BOOST_TEST(done.status == 0, done.err);
}

BOOST_AUTO_TEST_CASE(a_step_that_needs_more_is_not_begun) {
  app::hold_limits({.memory_MB = 300, .stored = "out/cache"});
  BOOST_CHECK_NO_THROW(app::check_held_memory(299, "linear elements", "ask for less"));
  BOOST_CHECK_EXCEPTION(
      app::check_held_memory(851, "quadratic elements", "ask for less"), app::LimitError, [](const auto& error) {
        return std::string(error.what()) ==
               "--max-memory: ended before quadratic elements: predicted to need 851 MB, the limit is 300 MB; finished "
               "results are stored in out/cache and reused by the next run; ask for less, or raise the limit";
      });
  app::hold_limits({});
  BOOST_CHECK_NO_THROW(app::check_held_memory(1e9, "anything", ""));
  BOOST_TEST(app::exceeded_limit().empty());
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
