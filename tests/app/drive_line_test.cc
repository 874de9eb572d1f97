#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"
#include "app/systems/shared/rotors.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/json.h"
#include "tests/app/run_program.h"
#include "tests/app/scene_refusal.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"
#include "tests/temporary_folder.h"

/// Scenes with rotors on shafts, and trains of several scenes.
BOOST_AUTO_TEST_SUITE(drive_lines)

using namespace annulus;

namespace {

constexpr const char* rotors = R"([[rotor]]
name = "motor"
on = "sun"
inertia_kg_m2 = 0.2
shaft_Nm_per_rad = 2e5
[[rotor]]
name = "flywheel"
on = "motor"
inertia_kg_m2 = 0.4
shaft_Nm_per_rad = 1e5
shaft_damping_ratio = 0.01
shaft_backlash_deg = 0.1
)";

/// Until the motion repeats.
std::string steady_stage() { return test::replaced(test::quick_scene(), "mesh_cycles = 110\n", ""); }

/// A pair with a prescribed stiffness.
std::string pair_scene(int pinion, int wheel, double torque, double speed) {
  return fmt::format(R"(title = "Pair"
[stage]
kind = "helical_pair"
module_mm = 4
pressure_angle_deg = 20
face_width_mm = 40
pinion_torque_Nm = {}
pinion_speed_rpm = {}
[material]
youngs_modulus_GPa = 206
[pinion]
teeth = {}
profile_shift = 0
mass_kg = 3
bearing_transverse_N_per_m = inf
[wheel]
teeth = {}
profile_shift = 0
mass_kg = 3
bearing_transverse_N_per_m = inf
[mesh.pinion_wheel]
stiffness = "harmonic"
mean_N_per_m = 4e8
ripple = 0.05
[dynamics]
half_backlash_um = 100
mesh_damping_ratio = 0.07
support_damping_ratio = 0.03
)",
                     torque, speed, pinion, wheel);
}

std::string train_scene(const std::string& more = "") {
  return R"(title = "Train"
[stage]
kind = "train"
[[part]]
name = "first"
file = "first.toml"
[[part]]
name = "second"
file = "parts/second.toml"
[[shaft]]
name = "between"
from = "first.wheel"
to = "second.pinion"
stiffness_Nm_per_rad = 5e4
[[rotor]]
name = "motor"
on = "first.pinion"
inertia_kg_m2 = 0.05
shaft_Nm_per_rad = 1e5
[dynamics]
support_damping_ratio = 0.05
)" + more;
}

/// The second part states other speeds and torques than it gets.
void write_train(const test::TemporaryFolder& folder, const std::string& more = "") {
  write_file(folder.path() / "train.toml", train_scene(more));
  write_file(folder.path() / "first.toml", pair_scene(20, 30, 200, 1200));
  std::filesystem::create_directories(folder.path() / "parts");
  write_file(folder.path() / "parts" / "second.toml", pair_scene(25, 35, 500, 333));
}

Json summary_of(const test::TemporaryFolder& folder) {
  return Json::parse(read_file(folder.path() / "out" / "summary.json"));
}

std::string refusal_of(const test::TemporaryFolder& folder) {
  try {
    (void)app::read_scene(folder.path() / "train.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

BOOST_AUTO_TEST_CASE(shafts_of_a_stage) {
  const test::TemporaryFolder folder("rotors");
  write_file(folder.path() / "scene.toml", steady_stage() + rotors);
  const auto outcome = test::run_program(folder.path(), "run scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const auto summary = summary_of(folder);
  const auto& ring = *summary["rings"].begin();
  BOOST_TEST_REQUIRE(ring["shafts"].size() == 2u);
  const double torque = summary["operating_point"]["sun_torque_N_m"];
  for (const auto& shaft : ring["shafts"]) {
    BOOST_TEST(std::abs(shaft["nominal_torque_N_m"].get<double>() / torque - 1) < 1e-9);
    BOOST_TEST(std::abs(shaft["mean_torque_N_m"].get<double>() / torque - 1) < 1e-3);
    BOOST_TEST(shaft["torque_factor"]["value"].get<double>() >= 1);
  }
  BOOST_TEST(ring["shafts"][1]["on"] == "motor");
  const auto report = read_file(folder.path() / "out" / "report.html");
  BOOST_TEST(report.find("flywheel – motor") != std::string::npos);
  // A change of a rotor changes no table, but the motion.
  const auto again =
      test::run_program(folder.path(), "run scene.toml --out out --set rotor.motor.inertia_kg_m2=0.3 --quiet");
  BOOST_TEST_REQUIRE(again.status == 0, again.err);
  const auto changed = summary_of(folder);
  BOOST_TEST(changed["rings"].begin()->at("natural_frequencies_Hz")[1]["value"].get<double>() <
             ring["natural_frequencies_Hz"][1]["value"].get<double>());
}

BOOST_AUTO_TEST_CASE(rotors_that_are_refused) {
  const auto refused = [](const std::string& from, const std::string& to) {
    return test::scene_refusal(test::replaced(steady_stage() + rotors, from, to));
  };
  const std::string second = "on = \"motor\"";
  BOOST_TEST(refused(second, "on = \"ring\"").find("it is held") != std::string::npos);
  BOOST_TEST(refused(second, "on = \"sun\"").find("let this one lead to 'motor'") != std::string::npos);
  BOOST_TEST(refused(second, "on = \"flywheel\"").find("no body") != std::string::npos);
  BOOST_TEST(refused("name = \"flywheel\"", "name = \"planet3\"").find("that of a body") != std::string::npos);
  BOOST_TEST(refused("inertia_kg_m2 = 0.4", "inertia_kg_m2 = 0.4\nripple_orders = [1, 2]\nripple_torques_Nm = [3]")
                 .find("has 1 values for 2 orders") != std::string::npos);
  BOOST_TEST(refused("inertia_kg_m2 = 0.4", "inertia_kg_m2 = 0.4\nripple_orders = [1, 2]").find("ripple_torques_Nm") !=
             std::string::npos);
  BOOST_TEST(refused("inertia_kg_m2 = 0.4", "inertia_kg_m2 = 0").find("rotor.inertia_kg_m2") != std::string::npos);
  BOOST_TEST(refused("name = \"flywheel\"", "name = \"fly wheel\"").find("letters, digits") != std::string::npos);
}

// The waves pass through the values, less their mean.
BOOST_AUTO_TEST_CASE(torque_over_a_turn) {
  const auto rotor_with = [](const std::string& keys) {
    return steady_stage() + "[[rotor]]\nname = \"engine\"\non = \"sun\"\ninertia_kg_m2 = 3\nshaft_Nm_per_rad = 1e6\n" +
           keys;
  };
  for (const auto& values : {std::vector<double>{10, -4, 7, 3, 1}, {3, 0, -2, 8, 5, 4}}) {
    const auto scene = app::parse_scene(
        rotor_with(fmt::format("torque_over_turn_Nm = [{}]\n", fmt::join(values, ", "))), "scene.toml");
    const auto ripples = app::rotors_of(scene).front().ripples;
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(values.size());
      double torque = 0;
      for (const auto& wave : ripples) torque += wave.amplitude * std::cos(wave.order * angle + wave.phase);
      BOOST_TEST(std::abs(torque - (values[i] - mean)) < 1e-12);
    }
  }
  BOOST_TEST(app::rotors_of(app::parse_scene(rotor_with("torque_over_turn_Nm = [5, 5, 5]\n"), "scene.toml"))
                 .front()
                 .ripples.empty());
  BOOST_TEST(
      test::scene_refusal(rotor_with("torque_over_turn_Nm = [1, 2]\nripple_orders = [1]\nripple_torques_Nm = [2]\n"))
          .find("torque_over_turn_Nm") != std::string::npos);
}

// 54 cycles per turn of the carrier: three of the ring mesh.
BOOST_AUTO_TEST_CASE(a_stage_in_gusts) {
  const test::TemporaryFolder folder("gusts");
  const auto scene = test::replaced(steady_stage(), "planet_eccentricity_um = [15, 36, 17, 38, 19]",
                                    "planet_eccentricity_um = [0, 0, 0, 0, 0]") +
                     R"([[rotor]]
name = "blades"
on = "carrier"
inertia_kg_m2 = 20
shaft_Nm_per_rad = 9e7
ripple_orders = [54]
ripple_torques_Nm = [5000]
)";
  write_file(folder.path() / "scene.toml", scene);
  const auto outcome = test::run_program(folder.path(), "run scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const auto torque_factor = [&] {
    const auto summary = summary_of(folder);
    return (*summary["rings"].begin())["shafts"][0]["torque_factor"]["value"].get<double>();
  };
  const double in_gusts = torque_factor();
  write_file(folder.path() / "scene.toml",
             test::replaced(scene, "ripple_torques_Nm = [5000]", "ripple_torques_Nm = [0]"));
  BOOST_TEST_REQUIRE(test::run_program(folder.path(), "run scene.toml --out out --quiet").status == 0);
  BOOST_TEST(torque_factor() < 1 + 0.2 * (in_gusts - 1));
  // A ring on a torsional support does not turn.
  const auto brake = test::replaced(test::replaced(scene, "on = \"carrier\"", "on = \"ring\""), "[supports]\n",
                                    "[supports]\nring_torsional_N_per_m = 1e9\n");
  write_file(folder.path() / "brake.toml", brake);
  const auto refused = test::run_program(folder.path(), "check brake.toml");
  BOOST_TEST(refused.status != 0);
  BOOST_TEST(refused.err.find("brake.toml:") != std::string::npos, refused.err);
  BOOST_TEST(refused.err.find("rotor.ripple_orders") != std::string::npos, refused.err);
  BOOST_TEST(refused.err.find("needs a rotor that turns") != std::string::npos, refused.err);
}

BOOST_AUTO_TEST_CASE(a_train) {
  const test::TemporaryFolder folder("train");
  write_train(folder);
  const auto outcome = test::run_program(folder.path(), "run train.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const auto summary = summary_of(folder);
  BOOST_TEST(summary["dynamics"]["steady"] == true);
  // By hand: 1200 r/min and 200 N m, 20/30, then 25/35.
  BOOST_TEST_REQUIRE(summary["meshes"].size() == 2u);
  BOOST_TEST(std::abs(summary["meshes"][0]["mesh_frequency_Hz"].get<double>() - 400) < 1e-6);
  BOOST_TEST(std::abs(summary["meshes"][1]["mesh_frequency_Hz"].get<double>() - 25 * 800 / 60.0) < 1e-6);
  const double base = 4e-3 * 25 / 2 * std::cos(20 * M_PI / 180);
  BOOST_TEST(std::abs(summary["meshes"][1]["mean_force_N"].get<double>() * base / 300 - 1) < 1e-3);
  BOOST_TEST_REQUIRE(summary["shafts"].size() == 2u);
  BOOST_TEST(std::abs(summary["shafts"][0]["mean_torque_N_m"].get<double>() / 300 - 1) < 1e-3);
  BOOST_TEST(std::abs(summary["shafts"][1]["mean_torque_N_m"].get<double>() / 200 - 1) < 1e-3);
  // 6 cycles of the first mesh and 5 of the second one.
  BOOST_TEST(summary["dynamics"]["whole_period"] == true);
  const auto plan = test::run_program(folder.path(), "plan train.toml --inputs");
  BOOST_TEST(plan.out.find("second: pinion.teeth") != std::string::npos, plan.out);
  // The operating point and the accuracy of the train, not those of the part's own scene.
  std::map<std::string, Json> inputs;
  for (const auto& input : summary["inputs"]) inputs[input["key"]] = input["value"];
  BOOST_TEST(inputs["second: stage.pinion_torque_Nm"].get<double>() == 300, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(inputs["second: accuracy"].get<double>() == inputs["accuracy"].get<double>());
  // A part that has changed: nothing is taken for unchanged.
  write_file(folder.path() / "parts" / "second.toml", pair_scene(26, 35, 500, 333));
  BOOST_TEST_REQUIRE(test::run_program(folder.path(), "run train.toml --out out --quiet").status == 0);
  const auto changed = summary_of(folder);
  BOOST_TEST(std::abs(changed["meshes"][1]["mesh_frequency_Hz"].get<double>() - 26 * 800 / 60.0) < 1e-6);
  BOOST_TEST(changed["inputs_id"] != summary["inputs_id"]);
}

// Two bearings beside the face of each gear, 40 and 60 mm from its middle, share the mesh force as a beam's supports
// do.
BOOST_AUTO_TEST_CASE(bearings_of_a_part) {
  const test::TemporaryFolder folder("train_in_space");
  write_train(folder);
  auto second = pair_scene(25, 35, 500, 333);
  for (const std::string gear : {"pinion", "wheel"})
    for (const auto& [name, at] : {std::pair{"near", -40}, {"far", 60}})
      second += fmt::format("[[bearing]]\nname = \"{} {}\"\nbody = \"{}\"\nat_mm = {}\nradial_N_per_m = 2e8\n{}", gear,
                            name, gear, at, at < 0 ? "axial_N_per_m = 1e8\n" : "");
  write_file(folder.path() / "parts" / "second.toml", second);
  const auto outcome = test::run_program(folder.path(), "run train.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const auto summary = summary_of(folder);
  const auto& found = summary["parts"]["second"]["bearings_in_space"];
  BOOST_TEST_REQUIRE(found.size() == 4u);
  const double force = 300 / (4e-3 * 25 / 2 * std::cos(20 * M_PI / 180));
  // The gears tilt a little in bearings that are not symmetric, and their force leaves the middle of the face.
  BOOST_TEST_REQUIRE(summary["parts"]["second"]["places_of_mesh_forces"].size() == 1u);
  const double place = summary["parts"]["second"]["places_of_mesh_forces"].begin()->at("mean_m").get<double>();
  BOOST_TEST(std::abs(place) < 2e-3);
  for (const std::string gear : {"pinion", "wheel"}) {
    const double near = force * (0.06 - place) / 0.1, far = force * (0.04 + place) / 0.1;
    BOOST_TEST(std::abs(found[gear + "_" + gear + "_near"]["radial_mean_N"].get<double>() / near - 1) < 1e-3);
    BOOST_TEST(std::abs(found[gear + "_" + gear + "_far"]["radial_mean_N"].get<double>() / far - 1) < 1e-3);
  }
  BOOST_TEST(!summary["parts"].contains("first"));
  BOOST_TEST(Csv::read(folder.path() / "out/dynamics/bearings_in_space_second.csv").rows.size() ==
             summary["dynamics"]["window_cycles"].get<std::size_t>());
  BOOST_TEST(read_file(folder.path() / "out/report.html").find("Bearings and faces in space") != std::string::npos);
}

// Two cycles per turn of a four-stroke engine of four cylinders; 20 teeth: ten cycles of the mesh.
BOOST_AUTO_TEST_CASE(an_engine) {
  const test::TemporaryFolder folder("engine");
  write_file(folder.path() / "scene.toml", pair_scene(20, 30, 200, 1200) + R"([[rotor]]
name = "engine"
on = "pinion"
inertia_kg_m2 = 0.3
shaft_Nm_per_rad = 2e4
ripple_orders = [2, 4]
ripple_torques_Nm = [150, 40]
)");
  const auto outcome = test::run_program(folder.path(), "run scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const auto response = summary_of(folder)["response"];
  BOOST_TEST(response["steady"] == true);
  BOOST_TEST(response["window_cycles"].get<int>() % 10 == 0);
  BOOST_TEST(response["shafts"][0]["torque_factor"]["value"].get<double>() > 1.01);
}

BOOST_AUTO_TEST_CASE(a_sweep_of_a_train) {
  const test::TemporaryFolder folder("train_sweep");
  write_train(folder, R"([[sweep]]
input = "stage.speed_factor"
from = 0.5
to = 2
count = 4
[[sweep]]
input = "shaft.between.stiffness_Nm_per_rad"
from = 1e4
to = 1e5
count = 3
)");
  const auto outcome = test::run_program(folder.path(), "run train.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const auto sweeps = summary_of(folder)["sweeps"];
  BOOST_TEST(sweeps.size() == 2u, outcome.err);
}

BOOST_AUTO_TEST_CASE(trains_that_are_refused) {
  const test::TemporaryFolder folder("bad_train");
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& word) {
    write_train(folder);
    write_file(folder.path() / "train.toml", test::replaced(train_scene(), from, to));
    const auto text = refusal_of(folder);
    BOOST_TEST(text.find(word) != std::string::npos, text);
  };
  refused("file = \"first.toml\"", "file = \"furst.toml\"", "no such file");
  refused("file = \"first.toml\"", "file = \"../first.toml\"", "leads out of the scene's folder");
  refused("file = \"first.toml\"", "file = \"train.toml\"", "cannot be that of a part");
  refused("name = \"second\"", "name = \"first\"", "used for two parts");
  refused("name = \"second\"", "name = \"a.b\"", "letters");
  refused("name = \"second\"", "name = \"dynamics\"", "that a run writes itself");
  refused("name = \"between\"", "name = \"a.b\"", "letters");
  refused("inertia_kg_m2 = 0.05", "inertia_kg_m2 = 0.05\nripple_orders = [1, 2]\nripple_torques_Nm = [3]",
          "1 values for 2 orders");
  refused("on = \"first.pinion\"", "on = \"first.wheel\"", "shaft 'between' leads to it");
  refused("on = \"first.pinion\"", "on = \"first.sun\"", "one of first.pinion");
  refused("from = \"first.wheel\"", "from = \"first.sun\"", "must be one of first.pinion");
  refused("kind = \"train\"", "kind = \"train\"\nmodule_mm = 3", "stage.module_mm");
  refused("support_damping_ratio = 0.05", "support_damping_ratio = 0.05\nhalf_backlash_um = 3", "half_backlash_um");
  write_train(folder);
  write_file(folder.path() / "first.toml", test::replaced(pair_scene(20, 30, 200, 1200), "module_mm = 4\n", ""));
  BOOST_TEST(refusal_of(folder).find("stage.module_mm") != std::string::npos);
  write_file(folder.path() / "first.toml",
             pair_scene(20, 30, 200, 1200) +
                 "[[rotor]]\nname = \"m\"\non = \"pinion\"\ninertia_kg_m2 = 1\nshaft_Nm_per_rad = 1e5\n");
  BOOST_TEST(refusal_of(folder).find("give them to the train") != std::string::npos);
  // A part without a torque.
  write_train(folder);
  write_file(folder.path() / "parts" / "second.toml",
             pair_scene(25, 35, 0, 333) + "[errors]\nmesh_error_um = 1\nmesh_error_phase_deg = 0\n");
  const auto idle = test::run_program(folder.path(), "check train.toml");
  BOOST_TEST(idle.status != 0);
  BOOST_TEST(idle.err.find("must differ from 0") != std::string::npos, idle.err);
  // Both ends of a shaft take up power.
  write_train(folder);
  write_file(folder.path() / "train.toml",
             test::replaced(train_scene(), "to = \"second.pinion\"", "to = \"second.wheel\""));
  const auto outcome = test::run_program(folder.path(), "check train.toml");
  BOOST_TEST(outcome.status != 0);
  BOOST_TEST(outcome.err.find("both deliver power") != std::string::npos, outcome.err);
}

BOOST_AUTO_TEST_SUITE_END()
