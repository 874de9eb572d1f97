#include "app/process/held_limits.h"

#include <boost/test/unit_test.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/csv.h"
#include "core/files.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

namespace annulus {

namespace {

std::filesystem::path put_fault(const std::filesystem::path& folder, const std::string& name) {
  write_file(folder / "scene.toml", read_file(std::filesystem::path(ANNULUS_SOURCE_DIR) / "tests/app/faults" / name));
  return folder / "scene.toml";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(held_limits)

BOOST_AUTO_TEST_CASE(a_plan_states_what_quadratic_elements_would_cost) {
  const test::TemporaryFolder folder("worst_plan");
  put_fault(folder.path(), "limits_not_held.toml");
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
  BOOST_TEST(refused.err.find("if quadratic elements have to follow linear ones") != std::string::npos, refused.err);
  BOOST_TEST(refused.err.find(" (--max-memory)") != std::string::npos);
  BOOST_TEST(!std::filesystem::exists(folder.path() / "out"));
}

BOOST_AUTO_TEST_CASE(a_run_ends_at_its_limits_whatever_was_predicted) {
  const test::TemporaryFolder folder("held");
  write_file(folder.path() / "scene.toml", test::quick_scene());
  // Tables that the scene prescribes are predicted to cost nothing.
  for (const auto& [option, words] : {std::pair{"--max-time 10ms", "--max-time: ended during "},
                                      std::pair{"--max-memory 1MB", "--max-memory: ended during "}}) {
    const auto ended = test::run_program(folder.path(), std::string("solve scene.toml -o out ") + option);
    BOOST_TEST(ended.status == 4, ended.err);
    BOOST_TEST(ended.err.find(words) != std::string::npos, ended.err);
    for (const auto* word : {"the limit is ", "finished results are stored in out/cache", "raise the limit"})
      BOOST_TEST(ended.err.find(word) != std::string::npos, ended.err);
  }
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

BOOST_AUTO_TEST_SUITE(contact_faults)

BOOST_AUTO_TEST_CASE(a_thin_rim_on_bolts_gives_way_more_under_more_load) {
  const test::TemporaryFolder folder("omitted_pair");
  put_fault(folder.path(), "omitted_pair.toml");
  const auto solved = test::run_program(folder.path(), "solve scene.toml -o out --quiet --threads 2");
  BOOST_TEST_REQUIRE(solved.status == 0, solved.err);
  const auto csv = Csv::read(folder.path() / "out/ring/lte_ring_planet.csv");
  const auto cycle = csv.column("ring_tooth"), phase = csv.column("mesh_phase"), load = csv.column("load_N"),
             lte = csv.column("lte_um");
  std::map<std::pair<double, double>, std::map<double, double>> curves;
  for (const auto& row : csv.rows) curves[{row[cycle], row[phase]}][row[load]] = row[lte];
  BOOST_TEST(curves.size() > 100U);
  for (const auto& [position, curve] : curves) {
    double before = 0;
    for (const auto& [force, error] : curve) {
      BOOST_TEST(error > before, "ring tooth " << position.first << ", phase " << position.second << ", " << force);
      before = error;
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
