#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/export/rexs.h"
#include "app/model/gear_system.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/stage_geometry.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "core/units.h"
#include "tests/app/scenes.h"
#include "tests/app/stated_results.h"

namespace annulus {

namespace {

using geometry::StageMember;

/// The quick scene with other lines instead of that of the sun's speed.
std::string flowing(const std::string& lines) {
  return test::replaced(test::quick_scene(), "sun_speed_rpm = 1128\n", lines);
}

app::OperatingPoint point_of(const std::string& lines) {
  return app::make_geometry(app::parse_scene(flowing(lines), "scene.toml")).operating_point;
}

/// One refusal that holds all the words.
void check_refused(const std::string& lines, const std::vector<std::string>& words) {
  try {
    (void)app::parse_scene(flowing(lines), "scene.toml");
    BOOST_ERROR("accepted: " << lines);
  } catch (const app::SceneError& error) {
    BOOST_TEST_REQUIRE(error.problems().size() == 1U, lines << error.what());
    for (const auto& word : words)
      BOOST_TEST(error.problems().front().message.find(word) != std::string::npos, error.what() << " lacks " << word);
  }
}

void run(const std::string& text, const std::filesystem::path& out) {
  log::set_level(log::Level::quiet);
  (void)app::run(app::parse_scene(text, "scene.toml"), {.out = out, .threads = 1});
}

/// Results by their keys, of the only ring.
std::map<std::string, double> results_of(const std::string& text, const std::filesystem::path& out) {
  run(text, out);
  std::map<std::string, double> results;
  for (const auto& [key, figure] : test::stated_results(out)) results[key] = figure.value;
  return results;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(power_flows)

BOOST_AUTO_TEST_CASE(speeds_torques_and_powers_of_every_flow) {
  const auto close = boost::test_tools::tolerance(1e-12);
  constexpr double sun = 1128 * units::rpm, power = 2958.8e3, ratio = 1 + 162.0 / 48;
  const auto reducer = point_of("sun_speed_rpm = 1128\n");
  BOOST_TEST(!reducer.mirrored);
  BOOST_TEST(reducer.flow.speed[StageMember::carrier] == sun / ratio, close);
  BOOST_TEST(reducer.flow.torque[StageMember::carrier] == -power / sun * ratio, close);
  BOOST_TEST(reducer.flow.power(StageMember::carrier) == -power, close);

  const auto increaser = point_of(fmt::format("drives = \"carrier\"\ncarrier_speed_rpm = {:.17g}\n", 1128 / ratio));
  BOOST_TEST(increaser.mirrored);  // the torque of the sun opposes its motion
  BOOST_TEST(increaser.flow.torque[StageMember::sun] == -power / sun, close);
  BOOST_TEST(increaser.sun_torque == reducer.sun_torque, close);
  BOOST_TEST(increaser.computed_speed(StageMember::carrier) == -sun / ratio, close);
  BOOST_TEST(increaser.mesh_frequency == reducer.mesh_frequency, close);

  const auto star = point_of("held = \"carrier\"\nsun_speed_rpm = 1128\n");
  BOOST_TEST(star.flow.speed[StageMember::ring] == -sun * 48 / 162, close);
  BOOST_TEST(star.flow.power(StageMember::ring) == -power, close);
  BOOST_TEST(star.mesh_frequency == 48 * 1128 / 60.0, close);

  const auto solar = point_of("held = \"sun\"\ndrives = \"ring\"\nring_speed_rpm = 300\n");
  BOOST_TEST(solar.flow.speed[StageMember::carrier] == 300 * units::rpm / (1 + 48.0 / 162), close);
  BOOST_TEST(solar.flow.power(StageMember::carrier) == -power, close);

  const auto differential = point_of("held = \"none\"\nsun_speed_rpm = 1128\nring_speed_rpm = -100\n");
  double sum = 0;
  for (const auto member : {StageMember::sun, StageMember::carrier, StageMember::ring})
    sum += differential.flow.power(member);
  BOOST_TEST(std::abs(sum) < 1e-9 * power);
  BOOST_TEST(differential.flow.power(StageMember::sun) == power, close);
  BOOST_TEST(differential.flow.power(StageMember::ring) < 0);
}

BOOST_AUTO_TEST_CASE(impossible_flows_are_refused) {
  check_refused("", {"stage.sun_speed_rpm", "one of sun_speed_rpm, carrier_speed_rpm, ring_speed_rpm is required"});
  check_refused("sun_speed_rpm = 100\ncarrier_speed_rpm = 20\n",
                {"stage.carrier_speed_rpm = 20", "is given beside stage.sun_speed_rpm", "give one of"});
  check_refused(
      "held = \"none\"\nsun_speed_rpm = 100\n",
      {"stage.carrier_speed_rpm", "two of stage.sun_speed_rpm, stage.carrier_speed_rpm, stage.ring_speed_rpm"});
  check_refused("held = \"sun\"\ncarrier_speed_rpm = 20\n",
                {"stage.drives", "the sun is held", "\"carrier\" or \"ring\""});
  check_refused("sun_speed_rpm = 100\nring_speed_rpm = 20\n", {"stage.ring_speed_rpm", "the ring is held"});
  check_refused("sun_speed_rpm = 0\n", {"stage.sun_speed_rpm = 0", "1e-06 r/min"});
  check_refused("held = \"none\"\nsun_speed_rpm = 100\nring_speed_rpm = 100\n",
                {"stage.sun_speed_rpm", "all members then turn at the same speed"});
  check_refused("held = \"none\"\nsun_speed_rpm = 0\nring_speed_rpm = 100\n",
                {"stage.drives", "the sun turns at 0 r/min", "\"carrier\" or \"ring\""});
  const auto supported = [](const std::string& lines, const std::string& support, const std::string& words) {
    const auto text = test::replaced(flowing(lines), "[supports]\n", "[supports]\n" + support);
    try {
      (void)app::parse_scene(text, "scene.toml");
      BOOST_ERROR("accepted: " << support);
    } catch (const app::SceneError& error) {
      BOOST_TEST(std::string(error.what()).find(words) != std::string::npos, error.what());
    }
  };
  supported("sun_speed_rpm = 100\n", "ring_torsional_N_per_m = 0\n", "leaves the ring free, but stage.held");
  supported("held = \"carrier\"\nsun_speed_rpm = 100\n", "ring_torsional_N_per_m = \"rigid\"\n",
            "holds the ring rigidly, but stage.held = \"carrier\"");
}

// A scene and what is seen of it in a mirror: all directions reversed. Planets 2 to 5 of one are 5 to 2 of the other.
BOOST_AUTO_TEST_CASE(the_mirror_image_driven_the_other_way_gives_the_same) {
  const test::TemporaryFolder folder("mirror");
  const std::string phases = "planet_eccentricity_phase_deg = [0, 0, 0, 0, 0]\n";
  const auto scene = test::replaced(test::replaced(test::quick_scene(), phases,
                                                   "planet_eccentricity_phase_deg = [10, 20, 30, 40, 50]\n"
                                                   "planet_pin_position_error_um = [1, 2, 3, 4, 5]\n"
                                                   "planet_pin_position_error_phase_deg = [60, 70, 80, 90, 100]\n"
                                                   "sun_eccentricity_um = 6\nsun_eccentricity_phase_deg = 110\n"
                                                   "ring_position_error_um = 7\nring_position_error_phase_deg = 120\n"),
                                    "mesh_cycles = 110", "mesh_cycles = 60");
  auto mirrored = test::replaced(scene, "sun_speed_rpm = 1128", "sun_speed_rpm = -1128");
  for (const auto& [from, to] : {std::pair{"[15, 36, 17, 38, 19]", "[15, 19, 38, 17, 36]"},
                                 {"[10, 20, 30, 40, 50]", "[-10, -50, -40, -30, -20]"},
                                 {"[1, 2, 3, 4, 5]", "[1, 5, 4, 3, 2]"},
                                 {"[60, 70, 80, 90, 100]", "[-60, -100, -90, -80, -70]"},
                                 {"phase_deg = 110", "phase_deg = -110"},
                                 {"phase_deg = 120", "phase_deg = -120"}})
    mirrored = test::replaced(mirrored, from, to);
  const auto expected = results_of(scene, folder.path() / "a"), found = results_of(mirrored, folder.path() / "b");
  BOOST_TEST(expected.size() > 10U);
  for (const auto& [key, value] : expected)
    BOOST_TEST(std::abs(found.at(key) - value) <= 1e-6 * std::abs(value) + 1e-12, key);
  // Without the mirror image of the errors it is another stage.
  const auto other =
      results_of(test::replaced(scene, "sun_speed_rpm = 1128", "sun_speed_rpm = -1128"), folder.path() / "c");
  const std::string sharing = "sun_planet_load_sharing_averaged";
  BOOST_TEST(std::abs(other.at(sharing) / expected.at(sharing) - 1) > 1e-3);
}

// Elements depend on the force of a mesh alone.
BOOST_AUTO_TEST_CASE(a_sweep_of_the_speed_at_a_torque_solves_no_elements) {
  const std::string sweep = "[[sweep]]\ninput = \"stage.ring_speed_rpm\"\nvalues = [-450, 100, 300]\n";
  const auto tables = [&](const char* load) {
    auto text = test::replaced(test::small_stage(), "power_kW = 200\nsun_speed_rpm = 1500\n",
                               std::string("held = \"none\"\nsun_speed_rpm = 1500\nring_speed_rpm = -50\n") + load);
    const auto plan = app::make_plan(app::parse_scene(text + sweep, "scene.toml"));
    BOOST_TEST_REQUIRE(plan.studies.size() == 1U);
    return plan.studies.front().tables;
  };
  BOOST_TEST(tables("sun_torque_Nm = 1200\n") == 0);
  BOOST_TEST(tables("power_kW = 200\n") == 0);  // the speed of the sun, which drives, stays
  // At -450 r/min the carrier is slow, and its torque ten times as large: no load of the tables.
  BOOST_TEST(tables("drives = \"carrier\"\npower_kW = 200\n") == 2);
}

// What is computed as its mirror image is drawn and exported as it is.
BOOST_AUTO_TEST_CASE(drawings_keep_the_hand_of_the_helix) {
  const auto text = [](const char* drives) {
    auto scene = flowing(std::string(drives) + "sun_speed_rpm = 1128\n");
    for (const auto& [from, to] : {std::pair{"module_mm = 3.8", "helix_angle_deg = 5\nmodule_mm = 3.8"},
                                   {"centre_distance_mm = 201", "centre_distance_mm = 202"},
                                   {"profile_shift = 0.1516", "profile_shift = 0.4"}})
      scene = test::replaced(scene, from, to);
    return scene;
  };
  const auto scene = [&](const char* drives) { return app::parse_scene(text(drives), "scene.toml"); };
  const auto forwards = scene(""), back = scene("drives = \"carrier\"\n");
  BOOST_TEST(back.stage.helix_angle == -forwards.stage.helix_angle);  // as it is computed
  const auto drawn = [](const app::Scene& of) { return app::make_system(of)->drawing().gears; };
  const auto expected = drawn(forwards), found = drawn(back);
  BOOST_TEST_REQUIRE(expected.size() == 3U);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    BOOST_TEST(found[i].gear.helix_angle() == expected[i].gear.helix_angle());
    BOOST_TEST(found[i].gear.helix_angle() != 0.0);
  }
  const auto exported = app::rexs_text(back, "held"), other = app::rexs_text(forwards, "held");
  const std::string key = "helix_angle_reference_diameter";
  BOOST_TEST(exported.substr(exported.find(key), 80) == other.substr(other.find(key), 80));
}

BOOST_AUTO_TEST_CASE(results_state_who_drives) {
  const test::TemporaryFolder folder("flow");
  run(flowing("held = \"carrier\"\ndrives = \"ring\"\nring_speed_rpm = 300\n"), folder.path());
  const auto json = nlohmann::json::parse(read_file(folder.path() / "summary.json"));
  const auto& members = json["operating_point"]["members"];
  BOOST_TEST(members["ring"]["role"] == "drives");
  BOOST_TEST(members["carrier"]["role"] == "held");
  BOOST_TEST(members["sun"]["role"] == "delivers");
  BOOST_TEST(members["sun"]["speed_rad_per_s"].get<double>() == -300 * units::rpm * 162 / 48,
             boost::test_tools::tolerance(1e-12));
  const auto page = read_file(folder.path() / "report.html");
  BOOST_TEST(page.find("Power flow") != std::string::npos);
  bool over_ring_speed = false;  // the Campbell diagram
  for (const auto& picture : std::filesystem::directory_iterator(folder.path() / "pictures"))
    over_ring_speed |= picture.path().string().find("over_ring_speed") != std::string::npos;
  BOOST_TEST(over_ring_speed);
  const double held = json["rings"]["held"]["bearing_forces"]["held_torque_mean_N_m"];
  BOOST_TEST(std::abs(held + members["carrier"]["torque_N_m"].get<double>()) < 2e-3 * std::abs(held));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
