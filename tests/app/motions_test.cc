#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "core/csv.h"
#include "core/files.h"
#include "core/json.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"
#include "tests/temporary_folder.h"

/// Runs and sweeps where several motions exist.
BOOST_AUTO_TEST_SUITE(motions)

using namespace annulus;

/// A spur pair on rigid bearings, whose natural frequency is the mesh frequency at 5982 r/min.
std::string spur_pair(double speed, const std::string& more = "") {
  return fmt::format(R"(title = "Spur pair"
[stage]
kind = "helical_pair"
module_mm = 4
pressure_angle_deg = 20
face_width_mm = 40
pinion_torque_Nm = 300
pinion_speed_rpm = {}
[material]
youngs_modulus_GPa = 206
[pinion]
teeth = 30
profile_shift = 0
mass_kg = 3
bore_diameter_mm = 40
bearing_transverse_N_per_m = inf
[wheel]
teeth = 30
profile_shift = 0
mass_kg = 3
bore_diameter_mm = 40
bearing_transverse_N_per_m = inf
[mesh.pinion_wheel]
stiffness = "harmonic"
mean_N_per_m = 3e8
ripple = 0.2
[dynamics]
half_backlash_um = 30
mesh_damping_ratio = 0.03
support_damping_ratio = 0.03
)",
                     speed) +
         more;
}

Json run(const test::TemporaryFolder& folder, const std::string& scene) {
  write_file(folder.path() / "scene.toml", scene);
  const auto outcome = test::run_program(folder.path(), "run scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  return Json::parse(read_file(folder.path() / "out/summary.json"));
}

const Json* warning(const Json& summary, const std::string& key) {
  for (const auto& w : summary.at("warnings"))
    if (w.at("key") == key) return &w;
  return nullptr;
}

const Json& motions_of(const Json& summary) { return summary.at("response").at("motions").at("found"); }

// Two stable motions at one speed: both are listed, and the results are those of the larger force.
BOOST_AUTO_TEST_CASE(a_run_lists_all_motions_and_leads_with_the_worst) {
  const test::TemporaryFolder folder("motions_1");
  const auto summary = run(folder, spur_pair(4900));
  const auto& found = motions_of(summary);
  BOOST_REQUIRE(found.size() == 2);
  BOOST_TEST(found[0].at("results_are_of_it").get<bool>());
  BOOST_TEST(found[0].at("mesh_force_max_N").get<double>() > 2 * found[1].at("mesh_force_max_N").get<double>());
  const double nominal = summary.at("response").at("static_force_N").get<double>();
  BOOST_TEST(summary.at("response").at("peak_factor").at("value").get<double>() * nominal ==
                 found[0].at("mesh_force_max_N").get<double>(),
             boost::test_tools::tolerance(0.01));
  double shares = 0;
  for (const auto& motion : found) shares += motion.at("share_of_starts").get<double>();
  BOOST_TEST(shares == 1, boost::test_tools::tolerance(1e-9));
  const auto* several = warning(summary, "several_motions");
  BOOST_REQUIRE(several != nullptr);
  BOOST_TEST(several->at("text").get<std::string>().find("2 stable motions were found") != std::string::npos);
  BOOST_TEST(warning(summary, "other_steady_states") == nullptr);
  BOOST_TEST(read_file(folder.path() / "out/report.html").find("share of the starts") != std::string::npos);
  // Without the search the run finds one of them and warns.
  const auto alone = run(folder, test::replaced(spur_pair(4900), "[dynamics]\n", "[dynamics]\nstarts = 0\n"));
  BOOST_TEST(alone.at("response").at("motions").is_null());
  BOOST_TEST((warning(alone, "several_motions") == nullptr));
  // Far from a resonance there is one.
  const auto away = run(folder, spur_pair(1000));
  BOOST_TEST(away.at("response").at("motions").is_null());
  BOOST_TEST(warning(away, "several_motions") == nullptr);
}

// Running up and down jumps at the folds of the branch; each value by itself has the larger one of both.
BOOST_AUTO_TEST_CASE(sweeps_run_up_and_down_and_trace_branches) {
  const test::TemporaryFolder folder("motions_2");
  const std::string sweep = "[[sweep]]\ninput = \"stage.pinion_speed_rpm\"\nfrom = 3500\nto = 6500\ncount = 31\n";
  const auto summary = run(folder, spur_pair(6500, sweep + "direction = \"branches\"\n" + sweep));
  const auto& json = summary.at("sweeps")[0];
  const auto up = json.at("mesh_force_max_N").get<std::vector<double>>(),
             down = json.at("down").at("mesh_force_max_N").get<std::vector<double>>(),
             each = summary.at("sweeps")[1].at("mesh_force_max_N").get<std::vector<double>>(),
             values = json.at("values").get<std::vector<double>>();
  const auto points = Csv::read(folder.path() / "out/dynamics/sweep_2.csv");
  std::vector<double> folds;
  for (const auto& event : json.at("branches")[0].at("events"))
    if (event.at("kind") == "fold") {
      folds.push_back(event.at("value").get<double>());
      BOOST_TEST(event.at("error").get<double>() < 0.01 * folds.back());
    }
  BOOST_REQUIRE(folds.size() >= 2);
  const double top = *std::max_element(folds.begin(), folds.end()),
               bottom = *std::min_element(folds.begin(), folds.end());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool between = values[i] > bottom && values[i] < top;
    if (std::min(std::abs(values[i] - bottom), std::abs(values[i] - top)) < 20) continue;
    BOOST_TEST((down[i] > 1.3 * up[i]) == between, values[i] << ": " << up[i] << " up, " << down[i] << " down");
    BOOST_TEST(each[i] >= 0.98 * std::max(up[i], down[i]), values[i] << ": " << each[i]);
    const double motions = points.rows[i][points.column("stable_motions")];
    BOOST_TEST((motions > 1) == between, values[i] << ": " << motions << " motions");
  }
  const auto csv = Csv::read(folder.path() / "out/dynamics/sweep_1_branches.csv");
  BOOST_TEST(csv.rows.size() > 100U);
  BOOST_TEST(
      std::any_of(csv.rows.begin(), csv.rows.end(), [&](const auto& row) { return row[csv.column("stable")] == 0; }));
  // A second run computes nothing again.
  const auto again = test::run_program(folder.path(), "run scene.toml --out out");
  BOOST_TEST(again.out.find("reused") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(directions_that_a_kind_does_not_offer_are_refused_by_check) {
  const test::TemporaryFolder folder("motions_3");
  write_file(folder.path() / "reducer.toml", test::reducer_scene() +
                                                 "[[sweep]]\ninput = \"dynamics.mesh_damping_ratio\"\nvalues = [0.05, "
                                                 "0.1]\ndirection = \"branches\"\n");
  const auto refused = test::run_program(folder.path(), "check reducer.toml");
  BOOST_TEST(refused.status != 0);
  BOOST_TEST(
      refused.err.find("sweep.direction = \"branches\" is not offered for stages of kind two_k_v; use \"both\"") !=
          std::string::npos,
      refused.err);
}

BOOST_AUTO_TEST_CASE(branches_that_cannot_be_followed_are_refused_by_check) {
  const test::TemporaryFolder folder("motions_4");
  const auto refusal = [&](const std::string& sweep) {
    write_file(folder.path() / "scene.toml", read_file(ANNULUS_SOURCE_DIR "/data/scenes/minimal.toml") +
                                                 "\n[[sweep]]\ndirection = \"branches\"\n" + sweep);
    const auto outcome = test::run_program(folder.path(), "check scene.toml");
    BOOST_TEST(outcome.status != 0);
    return outcome.err;
  };
  const auto whole = refusal("input = \"stage.planets\"\nvalues = [3, 4]\n");
  BOOST_TEST(whole.find("cannot follow stage.planets: it is a whole number") != std::string::npos, whole);
  const auto table = refusal("input = \"sun.bore_diameter_mm\"\nvalues = [40, 41]\n");
  BOOST_TEST(table.find("cannot follow sun.bore_diameter_mm: it changes the stiffness table") != std::string::npos,
             table);
}

BOOST_AUTO_TEST_SUITE_END()
