#include "app/systems/helical_pair/pair_run.h"
#include "app/systems/planetary/planetary_run.h"

#include <sys/wait.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "app/model/gear_system.h"
#include "app/plan/plan.h"
#include "app/study/studies.h"
#include "core/files.h"
#include "core/log.h"
#include "core/units.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

app::PairRunResult run_pair_text(const std::string& text, const std::filesystem::path& out, int threads = 2,
                                 bool with_dynamics = true) {
  log::set_level(log::Level::quiet);
  return app::run_pair(app::parse_scene(text, "pair.toml"),
                       {.out = out, .threads = threads, .with_dynamics = with_dynamics});
}

constexpr const char* small_studies = R"([transmission_error]
pinion_torques_Nm = [500, 5000, 50000]
pinion_speeds_rpm = [200, 1500, 3000, 3700]
[[grid]]
x_input = "stage.pinion_torque_Nm"
x_values = [5000, 20000, 50000]
y_input = "stage.pinion_speed_rpm"
y_values = [500, 1500]
[[sweep]]
input = "stage.pinion_speed_rpm"
values = [1000, 1500]
[sensitivity]
inputs = ["dynamics.mesh_damping_ratio"]
factor = 2
[monte_carlo]
samples = 5
)";

/// One column of a table without its first line of provenance.
std::vector<double> csv_column(const std::filesystem::path& file, const std::string& name) {
  const auto csv = Csv::read(file);
  std::vector<double> values;
  for (const auto& row : csv.rows) values.push_back(row[csv.column(name)]);
  return values;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(pair_run)

BOOST_AUTO_TEST_CASE(a_pair_runs_from_scene_to_report) {
  const test::TemporaryFolder folder("pair_whole");
  const auto result = run_pair_text(test::quick_pair() + small_studies, folder.path());
  for (const auto* file :
       {"summary.json", "report.html", "sensitivity.csv", "errors/samples.csv", "errors/histogram.csv",
        "errors/readings.csv", "dynamics/time_series.csv", "dynamics/spectrum.csv", "dynamics/modes.csv",
        "dynamics/transmission_error_shares.csv", "dynamics/causes_over_speed.csv", "dynamics/grid_1.csv",
        "dynamics/sweep_1.csv", "dynamics/monte_carlo.csv"})
    BOOST_TEST(std::filesystem::exists(folder.path() / file), file);
  const auto json = nlohmann::json::parse(read_file(folder.path() / "summary.json"));
  BOOST_TEST(json["kind"] == "helical_pair");
  BOOST_TEST(json["manufacturing_error"]["readings"].size() == 14U);
  BOOST_TEST(json["manufacturing_error"]["applied"] == "pinion_envelope");
  BOOST_TEST(json["mesh_error_m"].get<double>() == result.errors.amplitude);
  BOOST_TEST(json["transmission_error_shares"].size() == 3U);
  BOOST_TEST(json["grids"][0]["mesh_force_max_N"].size() == 6U);
  BOOST_TEST(json["response"]["steady"] == true);
  const auto report = read_file(folder.path() / "report.html");
  for (const auto* anchor : {"figures", "conclusions", "errors", "shares", "stiffness", "motion", "modes", "spread",
                             "sweeps", "grids", "sensitivity", "model", "inputs", "quality"})
    BOOST_TEST(report.find(" id=\"" + std::string(anchor) + "\"") != std::string::npos, anchor);
  // A page of its own: nothing is fetched.
  BOOST_TEST(report.find("http://") == report.find("http://www.w3.org/2000/svg"));
  BOOST_TEST(report.find("<script src") == std::string::npos);
  std::string words = report;  // without what is packed
  for (std::size_t at; (at = words.find("<script")) != std::string::npos;)
    words.erase(at, words.find("</script>", at) - at + 9);
  BOOST_TEST(!std::regex_search(words, std::regex("\\bnan\\b")));

  // The draws themselves: their quantile is the one reported.
  auto envelope = csv_column(folder.path() / "errors/samples.csv", "pinion_x1_m");
  const auto second = csv_column(folder.path() / "errors/samples.csv", "pinion_x2_m");
  for (std::size_t i = 0; i < envelope.size(); ++i) envelope[i] = std::hypot(envelope[i], second[i]);
  BOOST_TEST_REQUIRE(envelope.size() == 10000U);
  BOOST_TEST(dynamics::quantile_interval(envelope, 0.95).value == result.errors.amplitude,
             boost::test_tools::tolerance(1e-12));

  // Studies take the harmonic balance, the scene's own response is integrated from it: equal within its error.
  const auto& sweep = result.studies.sweeps.front();
  for (const auto* column : {"acceleration_max_m_per_s2", "mesh_force_max_N", "transmission_error_max_m"}) {
    const auto& nominal = result.studies.nominal.front().figure(column);
    const double value = sweep.variants[0][1].value(column);
    BOOST_TEST(std::abs(value - nominal.value) < 1e-3 * nominal.value, column);
    // And a point of a grid is the point of the sweep.
    BOOST_TEST(result.studies.grids.front().variants[0][4].value(column) == value);
  }
}

BOOST_AUTO_TEST_CASE(shares_follow_statics) {
  const test::TemporaryFolder folder("pair_shares");
  const auto result = run_pair_text(test::quick_pair() + small_studies, folder.path());
  const double cb = std::cos(result.geometry.base_helix_angle);
  for (const auto& row : result.shares) {
    BOOST_TEST_REQUIRE(row.failure.empty());
    // Quasi-static at constant stiffness the teeth follow the error: 2 e / cos b, whatever the torque. The peaks lie
    // between samples; they are refined to parts in 10^5.
    BOOST_TEST(row.shares.errors_alone.quasi_static == 2 * result.errors.amplitude / cb,
               boost::test_tools::tolerance(1e-4));
    // Deflection and what the ripple makes of it go with the torque. The ripple: 1/k between k (1 - 0.05) and
    // k (1 + 0.05) of the mesh alone.
    const double force = row.pinion_torque / result.geometry.pinion().base_radius() / cb;
    const double k = dynamics::mean_stiffness(result.pair->mesh);
    BOOST_TEST(row.shares.stiffness_alone.quasi_static == force / k * (1 / 0.95 - 1 / 1.05) / cb,
               boost::test_tools::tolerance(1e-4));
    // Of mesh and bearings in series along the normal; the mean of 1/k is 1/(k sqrt(1 - ripple^2)).
    const double bearings = result.pair->static_compliance() - 1 / k;
    BOOST_TEST(row.shares.load_deflection == force * (bearings + 1 / (k * std::sqrt(1 - 0.05 * 0.05))) / cb,
               boost::test_tools::tolerance(1e-6));
  }
  // The paper's conclusion for the range, and where it fails for the largest value.
  BOOST_TEST(result.shares.back().shares.errors_alone.quasi_static >
             result.shares.back().shares.stiffness_alone.quasi_static);
  const auto report = read_file(folder.path() / "report.html");
  BOOST_TEST(report.find("peak-to-peak transmission error <b>at all torques up to 50 kN m</b>, and of its largest "
                         "value <b>up to 0.5 kN m "
                         "only</b>") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_verdict_follows_the_numbers) {
  const test::TemporaryFolder folder("pair_verdict");
  // Errors a hundred times smaller: the stiffness takes over where the load is high.
  auto text = test::quick_pair() + small_studies;
  for (const auto* line : {"pinion_", "wheel_"}) {
    text = test::replaced(text, std::string(line) + "total_um = 48.927", std::string(line) + "total_um = 0.48927");
    text = test::replaced(text, std::string(line) + "tooth_to_tooth_um = 12.927",
                          std::string(line) + "tooth_to_tooth_um = 0.12927");
  }
  (void)run_pair_text(text, folder.path() / "small");
  BOOST_TEST(read_file(folder.path() / "small/report.html")
                 .find("peak-to-peak transmission error <b>up to 0.5 kN m only</b>, and of its largest value <b>at "
                       "none of the torques</b>") != std::string::npos);
  // Without ripple the stiffness moves nothing.
  (void)run_pair_text(test::replaced(text, "ripple = 0.05\n", ""), folder.path() / "constant");
  BOOST_TEST(read_file(folder.path() / "constant/report.html")
                 .find("peak-to-peak transmission error <b>at all torques up to 50 kN m</b>") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(threads_change_nothing_and_a_second_run_reads_back) {
  const test::TemporaryFolder folder("pair_threads");
  const auto text = test::quick_pair() + small_studies;
  (void)run_pair_text(text, folder.path() / "one", 1);
  (void)run_pair_text(text, folder.path() / "two", 2);
  for (const auto* file : {"dynamics/grid_1.csv", "dynamics/time_series.csv", "errors/samples.csv", "sensitivity.csv",
                           "dynamics/transmission_error_shares.csv", "dynamics/monte_carlo.csv"})
    BOOST_TEST((read_file(folder.path() / "one" / file) == read_file(folder.path() / "two" / file)), file);
  // Cached points are not computed again.
  const auto again = run_pair_text(text, folder.path() / "two", 2).reuse->counted(app::study_responses);
  BOOST_TEST(again.reused >= 6);
  // The answer of the pair itself, with its files and the responses to other torques and speeds.
  const auto before = read_file(folder.path() / "two" / "dynamics" / "transmission_error_shares.csv");
  std::filesystem::remove_all(folder.path() / "two" / "dynamics");
  const auto third = run_pair_text(text, folder.path() / "two", 2);
  const auto reused = third.reuse->reused();
  BOOST_TEST(std::count(reused.begin(), reused.end(), "dynamics of the pair") == 1);
  BOOST_TEST(read_file(folder.path() / "two" / "dynamics" / "transmission_error_shares.csv") == before);
  BOOST_TEST(third.speeds.size() == 4U);
  BOOST_TEST(again.computed == 0);
}

BOOST_AUTO_TEST_CASE(finite_elements_of_a_pair_are_solved_compared_and_reused) {
  const test::TemporaryFolder folder("pair_solved");
  const auto text = test::solved_pair() +
                    "[transmission_error]\npinion_torques_Nm = [200, 600, 1100]\n"
                    "[[sweep]]\ninput = \"stage.pinion_torque_Nm\"\nvalues = [400, 600, 2000]\n";
  const auto result = run_pair_text(text, folder.path());
  BOOST_TEST_REQUIRE(result.stiffnesses.size() == 3U);
  const double iso = result.stiffnesses[0].value, closed = result.stiffnesses[1].value,
               solved = result.stiffnesses[2].value;
  BOOST_TEST(result.stiffnesses[2].taken);
  // Two independent models of the same teeth, both in plane strain: cantilever formulas are a few per cent off.
  BOOST_TEST(std::abs(closed / solved - 1) < 0.05);
  // The ISO mean holds for solid discs; these are bored to two fifths of their diameter, and a formula for all
  // standard teeth scatters by some 10 % besides.
  BOOST_TEST(std::abs(iso / solved - 1) < 0.25);
  // The nominal table serves 400 N m as well, not 2000.
  BOOST_TEST(result.studies.sweeps.front().tables == 1);
  BOOST_TEST(std::filesystem::exists(folder.path() / "sweep/stage_pinion_torque_Nm/2000/stiffness_pinion_wheel.csv"));
  for (const auto& point : result.studies.sweeps.front().variants.front()) BOOST_TEST(point.failure.empty());
  // At the nominal load the quasi-static mean is the table's deflection and that of the bearings. The table gives the
  // mean of its deflection; the error wave around it has none.
  const double force = result.geometry.transverse_force;
  const double bearings = force * 2 / 1e9;
  BOOST_TEST(result.response->figures.quasi_static.transmission_error.mean.value ==
                 result.mesh.computed->lte_mean().value + bearings,
             boost::test_tools::tolerance(1e-3));
  // A stiffer table deflects less: the error of the table is carried into what the load bends. The phases add to it,
  // for a spur mesh has steep flanks between one pair and two: a hundredth of the whole is plenty.
  const auto lte = result.mesh.computed->lte_mean();
  const double carried = result.response->figures.quasi_static.transmission_error.largest.error;
  BOOST_TEST(carried > 0.9 * lte.value * lte.error_relative);
  BOOST_TEST(carried < lte.value * lte.error_relative +
                           0.01 * result.response->figures.quasi_static.transmission_error.largest.value);
  // The table is one that a scene can give.
  const auto with_table = test::replaced(test::solved_pair(), "stiffness = \"computed\"",
                                         "stiffness = \"table\"\nfile = \"stiffness_pinion_wheel.csv\"");
  const auto given = app::run_pair(app::parse_scene(with_table, folder.path() / "pair.toml"),
                                   {.out = folder.path() / "given", .threads = 2});
  BOOST_TEST(given.response->figures.force_max.value == result.response->figures.force_max.value,
             boost::test_tools::tolerance(1e-12));
  const auto again = run_pair_text(text, folder.path());
  BOOST_TEST(again.mesh.computed->reused);
  BOOST_TEST(again.response->figures.force_max.value == result.response->figures.force_max.value);
  BOOST_TEST(read_file(folder.path() / "report.html").find("finite elements (plane)") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(tables_outside_their_loads_fail_their_row_alone) {
  const test::TemporaryFolder folder("pair_outside");
  const auto result =
      run_pair_text(test::solved_pair() + "[transmission_error]\npinion_torques_Nm = [600, 5000]\n", folder.path());
  BOOST_TEST(result.shares[0].failure.empty());
  BOOST_TEST(!result.shares[1].failure.empty());
  BOOST_TEST(read_file(folder.path() / "report.html").find("Left out, because no response was found") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_scene_without_dynamics_has_stiffness_and_errors) {
  const test::TemporaryFolder folder("pair_solve");
  auto text = test::quick_pair();
  text.erase(text.find("[dynamics]"));
  const auto result = run_pair_text(text, folder.path());
  BOOST_TEST((result.response == nullptr));
  const auto report = read_file(folder.path() / "report.html");
  BOOST_TEST(report.find("id=\"stiffness\"") != std::string::npos);
  BOOST_TEST(report.find("id=\"errors\"") != std::string::npos);
  BOOST_TEST(report.find("id=\"motion\"") == std::string::npos);
  // `solve` of a scene with dynamics stops at the same place.
  BOOST_TEST((run_pair_text(test::quick_pair(), folder.path() / "solve", 1, false).response == nullptr));
}

BOOST_AUTO_TEST_CASE(the_other_direction_mirrors_the_pair) {
  const test::TemporaryFolder folder("pair_mirror");
  // Back flanks, the error half a turn on: every force changes its sign and nothing else.
  const auto forth = run_pair_text(test::quick_pair(), folder.path() / "forth");
  const auto back = run_pair_text(
      test::replaced(test::replaced(test::quick_pair(), "pinion_torque_Nm = 20000", "pinion_torque_Nm = -20000"),
                     "[manufacturing_error]", "[errors]\nmesh_error_phase_deg = 180\n[manufacturing_error]"),
      folder.path() / "back");
  const auto a = dynamics::loaded_force(forth.response->figures), b = dynamics::loaded_force(back.response->figures);
  // Equal motions, found separately to the tolerance of the solution.
  BOOST_TEST(b.largest.value == a.largest.value, boost::test_tools::tolerance(1e-5));
  BOOST_TEST(b.smallest.value == a.smallest.value, boost::test_tools::tolerance(1e-5));
  BOOST_TEST(back.response->figures.dynamic_factor.value == forth.response->figures.dynamic_factor.value,
             boost::test_tools::tolerance(1e-5));
}

BOOST_AUTO_TEST_CASE(scenes_of_the_paper_are_good) {
  for (const auto* name : {"helical_pair.toml", "helical_pair_solid.toml"}) {
    const auto scene = app::read_scene(std::filesystem::path(ANNULUS_SOURCE_DIR) / "data/scenes" / name);
    app::check_stage(scene);
    BOOST_TEST(app::to_text(app::make_plan(scene)).find("pinion y") != std::string::npos);
    BOOST_TEST(app::to_json(app::make_plan(scene)).at("degrees_of_freedom").size() == 6U);
    BOOST_CHECK_NO_THROW(app::check_studies(scene));
  }
}

BOOST_AUTO_TEST_CASE(the_program_takes_pairs) {
  const test::TemporaryFolder folder("pair_program");
  const auto scene = folder.path() / "pair.toml", log = folder.path() / "log";
  const auto status = [&](const std::string& text, const std::string& arguments) {
    std::ofstream(scene) << text;
    const int code =
        std::system((std::string(ANNULUS_PROGRAM) + " " + arguments + " > " + log.string() + " 2>&1").c_str());
    return WEXITSTATUS(code);
  };
  const auto file = scene.string(), out = " -o " + (folder.path() / "out").string();
  BOOST_TEST(status(test::quick_pair(), "check " + file) == 0);
  BOOST_TEST(read_file(log).find("OK (helical pair, 21 and 37 teeth)") != std::string::npos);
  BOOST_TEST(status(test::quick_pair(), "plan " + file) == 0);
  BOOST_TEST(read_file(log).find("ISO 6336-1, method B") != std::string::npos);
  BOOST_TEST(status(test::quick_pair(), "solve -q " + file + out) == 0);
  BOOST_TEST(status(test::quick_pair(), "dynamics -q " + file + out) == 0);
  BOOST_TEST(status(test::quick_pair(), "run " + file + out) == 0);
  BOOST_TEST(std::regex_search(read_file(log), std::regex("nominal inputs +137\\.9")));
  BOOST_TEST(status(test::replaced(test::quick_pair(), "teeth = 37", "teeth = 3"), "check " + file) == 2);
  BOOST_TEST(read_file(log).find("pair.toml:20:1: wheel.teeth = 3: must be in range") != std::string::npos,
             read_file(log));
}

BOOST_AUTO_TEST_CASE(draws_and_a_grid_meet_their_times) {
  const test::TemporaryFolder folder("pair_times");
  log::set_level(log::Level::quiet);
  const auto scene = app::parse_scene(test::quick_pair(), "pair.toml");
  const auto begin = std::chrono::steady_clock::now();
  (void)app::pair_errors(scene);
  const std::chrono::duration<double> draws = std::chrono::steady_clock::now() - begin;
  // Wanted: 10 000 draws in 50 ms; measured 5 ms. Left room for a machine that is busy.
  BOOST_TEST(draws.count() < ANNULUS_SLOWDOWN * 0.25);
  const auto result = run_pair_text(test::quick_pair() +
                                        "[[grid]]\nx_input = \"stage.pinion_torque_Nm\"\nx_from = 2500\nx_to = 50000\n"
                                        "x_count = 5\ny_input = \"stage.pinion_speed_rpm\"\ny_from = 200\ny_to = 4000\n"
                                        "y_count = 5\n",
                                    folder.path(), 1);
  double studies = 0;
  for (const auto& [stage, seconds] : result.timings) studies += stage == "studies" ? seconds : 0;
  // Wanted: 400 points in a minute, so 25 in 3.75 s; measured 0.1 s.
  BOOST_TEST(studies < ANNULUS_SLOWDOWN * 3.75);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
