#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "core/csv.h"
#include "core/files.h"
#include "core/units.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/scene_refusal.h"
#include "tests/app/scenes.h"
#include "tests/app/stated_results.h"
#include "tests/temporary_folder.h"
#include "tests/verification_record.h"

/// Friction on the flanks: losses of solved and of prescribed meshes, and the rules of its keys.
BOOST_AUTO_TEST_SUITE(friction_losses)

using namespace annulus;

namespace {

/// Mean distance (m) of the tooth pairs from the pitch point by their shares, at a load (N), from the file of
/// positions.
double mean_distance(const std::filesystem::path& file, double pitch_roll, double load) {
  const auto csv = Csv::read(file);
  const auto phase = csv.column("mesh_phase"), of_load = csv.column("load_N");
  double sum = 0;
  int rows = 0;
  for (const auto& row : csv.rows) {
    if (std::abs(row[of_load] - load) > 1e-3 * load || row[phase] >= 1) continue;
    ++rows;
    for (int pair = 1;; ++pair) {
      const auto name = "pair" + std::to_string(pair);
      if (std::find(csv.columns.begin(), csv.columns.end(), name + "_share") == csv.columns.end()) break;
      const double share = row[csv.column(name + "_share")];
      if (share > 0) sum += share * std::abs(row[csv.column(name + "_roll_mm")] * units::mm - pitch_roll);
    }
  }
  return sum / rows;
}

}  // namespace

// Power lost from the positions of the file, by sums over tooth pairs.
BOOST_AUTO_TEST_CASE(losses_of_a_solved_stage) {
  annulus::test::Verification record("Power lost in friction", "sum over the tooth pairs of the file of positions");
  const test::TemporaryFolder folder("annulus_friction");
  write_file(folder.path() / "scene.toml",
             "accuracy = 0.05\nmodel = \"plane\"\n" + test::small_stage() + "[friction]\ncoefficient = 0.06\n");
  const auto outcome = test::run_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  auto results = test::stated_results(folder.path() / "out");
  const double frequency = 1500.0 / 60 * 24 * 72 / 96, base = 48e-3 * std::cos(20 * units::deg);
  const double force = 200e3 / (1500 * units::rpm) / (4 * base), roll = 48e-3 * std::sin(20 * units::deg);
  double sum = 0;
  for (const auto& [mesh, teeth] :
       {std::pair{"sun_planet", 1.0 / 24 + 1.0 / 24}, {"ring_planet", 1.0 / 24 - 1.0 / 72}}) {
    const auto lost = results.at(std::string(mesh) + "_friction_loss_W");
    const auto file = folder.path() / "out" / (mesh == std::string("ring_planet") ? "ring" : "") /
                      ("lte_" + std::string(mesh) + ".csv");
    const double expected =
        4 * 0.06 * force * mean_distance(file, roll, force) * 2 * std::numbers::pi * frequency * teeth;
    record.close(mesh, "W", lost.value, expected, 0.03, "positions of the file are 1/16 of a mesh cycle apart");
    BOOST_TEST(lost.error > 0);
    BOOST_TEST(lost.error < 0.05 * lost.value);
    sum += lost.value;
  }
  record.close("efficiency", "", results.at("efficiency").value, 1 - sum / 200e3, 1e-9, "rounding");
  BOOST_TEST(results.at("sun_planet_friction_coefficient").value == 0.06);
  BOOST_TEST(outcome.out.find("Efficiency of the meshes, %") != std::string::npos, outcome.out);
}

// Friction carries a part of the torque: the teeth press on each other with less than its force, and nothing is amiss.
BOOST_AUTO_TEST_CASE(much_friction_is_no_lack_of_torque) {
  const test::TemporaryFolder folder("annulus_friction");
  write_file(folder.path() / "scene.toml",
             "accuracy = 0.01\nmodel = \"closed_form\"\n" + test::small_stage() + "[friction]\ncoefficient = 0.12\n");
  const auto outcome = test::run_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  BOOST_TEST(test::stated_results(folder.path() / "out").at("sun_planet_peak_factor").value > 1);
}

// With a prescribed stiffness tooth pairs share the load evenly, which the run says. More friction loses more.
BOOST_AUTO_TEST_CASE(losses_of_prescribed_meshes) {
  const test::TemporaryFolder folder("annulus_friction");
  const auto run = [&](const std::string& friction) {
    write_file(folder.path() / "scene.toml", test::quick_scene() + friction);
    const auto outcome = test::run_program(folder.path(), "run scene.toml -o out");
    BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
    return std::pair{test::stated_results(folder.path() / "out"), outcome.out + outcome.err};
  };
  auto [without, quiet] = run("");
  BOOST_TEST(without.count("efficiency") == 0U);
  BOOST_TEST(quiet.find("stiff teeth") == std::string::npos);
  auto [little, warned] = run("[friction]\ncoefficient = 0.03\n");
  auto [more, again] = run("[friction]\ncoefficient = 0.09\n");
  BOOST_TEST(warned.find("stiff teeth") != std::string::npos, warned);
  BOOST_TEST(std::abs((1 - more["efficiency"].value) / (1 - little["efficiency"].value) - 3) < 1e-9);
  BOOST_TEST((little["efficiency"].value > 0.98 && little["efficiency"].value < 0.999));
  BOOST_TEST(more["sun_planet_dynamic_factor"].value != without["sun_planet_dynamic_factor"].value);
  auto [oil, text] = run("[friction]\noil_viscosity_mPas = 40\nroughness_um = 0.5\nlubricant_factor = 1\n");
  BOOST_TEST(
      (oil["sun_planet_friction_coefficient"].value > 0.02 && oil["sun_planet_friction_coefficient"].value < 0.08));
}

// Spur teeth that share the load evenly: loss mu H_V, H_V = pi (1/z_1 + 1/z_2)(1 - e + e_1^2 + e_2^2) [ISO14179-2].
BOOST_AUTO_TEST_CASE(friction_of_a_pair) {
  annulus::test::Verification record("Power lost by a pair", "loss factor of gears with even load shares");
  const test::TemporaryFolder folder("annulus_friction");
  write_file(folder.path() / "scene.toml",
             test::replaced(test::quick_pair(), "helix_angle_deg = 14", "helix_angle_deg = 0") +
                 "[friction]\ncoefficient = 0.05\n");
  const auto outcome = test::run_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  auto results = test::stated_results(folder.path() / "out");
  const double alpha = 20 * units::deg, pitch = std::numbers::pi * std::cos(alpha);  // in modules
  const auto beyond = [&](int teeth) {
    const double base = teeth / 2.0 * std::cos(alpha), tip = teeth / 2.0 + 1;
    return (std::sqrt(tip * tip - base * base) - base * std::tan(alpha)) / pitch;
  };
  const double first = beyond(37), second = beyond(21), ratio = first + second;
  const double factor = std::numbers::pi * (1.0 / 21 + 1.0 / 37) * (1 - ratio + first * first + second * second);
  record.close("power lost over power", "", 1 - results.at("efficiency").value, 0.05 * factor, 5e-3,
               "256 values where pairs change");
}

// Losses are proportional to the coefficient.
BOOST_AUTO_TEST_CASE(efficiency_in_a_sweep) {
  const test::TemporaryFolder folder("annulus_friction");
  write_file(folder.path() / "scene.toml",
             test::quick_scene() +
                 "[friction]\ncoefficient = 0.05\n[[sweep]]\ninput = \"friction.coefficient\"\n"
                 "values = [0, 0.02, 0.06]\n");
  const auto outcome = test::run_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const auto csv = Csv::read(folder.path() / "out" / "held" / "dynamics" / "sweep_1.csv");
  const auto column = csv.column("efficiency");
  BOOST_TEST_REQUIRE(csv.rows.size() == 3U);
  BOOST_TEST(csv.rows[0][column] == 1);
  BOOST_TEST(std::abs((1 - csv.rows[2][column]) / (1 - csv.rows[1][column]) - 3) < 1e-9);
}

// Oil acts where teeth separate: it changes nothing else, and softens their impacts.
BOOST_AUTO_TEST_CASE(oil_within_the_backlash) {
  const test::TemporaryFolder folder("annulus_friction");
  const auto run = [&](const std::string& torque, const std::string& film) {
    write_file(folder.path() / "scene.toml",
               test::replaced(test::quick_pair(), "pinion_torque_Nm = 20000", "pinion_torque_Nm = " + torque) + film);
    const auto outcome = test::run_program(folder.path(), "run scene.toml -o out");
    BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
    return test::stated_results(folder.path() / "out");
  };
  const std::string film = "[squeeze_film]\nviscosity_mPas = 50\nleast_gap_um = 1\n";
  auto loaded = run("20000", ""), with_oil = run("20000", film);
  BOOST_TEST(loaded["contact_loss"].value == 0);
  BOOST_TEST(loaded["mesh_force_max_N"].value == with_oil["mesh_force_max_N"].value);
  auto rattling = run("300", ""), softened = run("300", film);
  BOOST_TEST(rattling["contact_loss"].value > 0);
  BOOST_TEST(softened["mesh_force_max_N"].value < rattling["mesh_force_max_N"].value);
  const auto without_dynamics = test::replaced(test::quick_pair(),
                                               "[dynamics]\nhalf_backlash_um = 150\nmesh_damping_ratio = 0.08\n"
                                               "support_damping_ratio = 0.05\n",
                                               "");
  BOOST_TEST(test::scene_refusal(without_dynamics + film).find("squeeze_film") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(keys_of_friction) {
  const auto refusal = [](const std::string& keys) {
    return test::scene_refusal(test::quick_scene() + "[friction]\n" + keys);
  };
  const auto says = [&](const std::string& keys, const std::string& part) {
    BOOST_TEST(refusal(keys).find(part) != std::string::npos, refusal(keys));
  };
  BOOST_TEST(refusal("coefficient = 0.05\n").empty());
  BOOST_TEST(refusal("oil_viscosity_mPas = 40\nroughness_um = 0.5\nlubricant_factor = 0.8\n").empty());
  says("", "coefficient");
  says("coefficient = 0.05\noil_viscosity_mPas = 40\nroughness_um = 0.5\n", "oil_viscosity_mPas");
  says("oil_viscosity_mPas = 40\nlubricant_factor = 1\n", "roughness_um");
  says("oil_viscosity_mPas = 40\nroughness_um = 0.5\n", "lubricant_factor");
  says("coefficient = 0.05\nlubricant_factor = 0.8\n", "lubricant_factor");
  says("coefficient = 1.5\n", "1.5");
}

BOOST_AUTO_TEST_CASE(efficiency_as_an_objective_needs_friction) {
  const test::TemporaryFolder folder("annulus_friction");
  const auto scene = test::quick_scene() +
                     "[optimise]\nobjective = [\"efficiency\"]\ngoal = \"largest\"\n[[optimise.variable]]\n"
                     "input = \"stage.power_kW\"\nlow = 1000\nhigh = 4000\n";
  write_file(folder.path() / "without.toml", scene);
  write_file(folder.path() / "with.toml", scene + "[friction]\ncoefficient = 0.05\n");
  const auto refused = test::run_program(folder.path(), "check without.toml");
  BOOST_TEST(refused.status != 0);
  BOOST_TEST(refused.err.find("[friction]") != std::string::npos, refused.err);
  const auto accepted = test::run_program(folder.path(), "check with.toml");
  BOOST_TEST(accepted.status == 0, accepted.err);
}

BOOST_AUTO_TEST_CASE(branches_are_refused_with_friction) {
  const test::TemporaryFolder folder("annulus_friction");
  write_file(folder.path() / "scene.toml",
             test::quick_scene() +
                 "[friction]\ncoefficient = 0.05\n[[sweep]]\ninput = \"stage.sun_speed_rpm\"\nfrom = "
                 "1000\nto = 1200\ncount = 3\ndirection = \"branches\"\n");
  const auto outcome = test::run_program(folder.path(), "run scene.toml -o out");
  BOOST_TEST(outcome.status != 0);
  BOOST_TEST(outcome.err.find("friction") != std::string::npos, outcome.err);
}

BOOST_AUTO_TEST_SUITE_END()
