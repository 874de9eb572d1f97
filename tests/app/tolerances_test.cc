#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/model/gear_system.h"
#include "app/systems/planetary/planetary_run.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "core/units.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

app::RunResult run_toleranced(const std::string& text, const std::filesystem::path& out) {
  log::set_level(log::Level::quiet);
  return app::run(app::parse_scene(text, "scene.toml"), {.out = out, .threads = 2});
}

std::string message_of(const std::string& text) {
  try {
    app::check_stage(app::parse_scene(text, "scene.toml"));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

const std::string table = "[tolerances]\nassemblies = 200\nplanet_pin_position_um = 40\n";

}  // namespace

BOOST_AUTO_TEST_SUITE(tolerances)

/// 48, 55 and 162 teeth of module 3.8 mm: 0.9 (0.002 d + 0.55 sqrt(d) + 2.66 + 12) µm in class 5, √2 times as much in
/// class 6 [ISO1328-1], by hand: 28.5 -> 29 µm for the sun (d = 182.4 mm).
BOOST_AUTO_TEST_CASE(zones_follow_from_class_and_tolerances) {
  const auto zones_of = [](const std::string& text) {
    const auto scene = app::parse_scene(test::quick_scene() + text, "scene.toml");
    return app::stage_tolerances(scene, app::make_geometry(scene), 0);
  };
  const auto zones = zones_of("[tolerances]\naccuracy_class = 6\nring_runout_um = 50\nplanet_pin_position_um = 30\n");
  BOOST_TEST(zones.planet_pin_position == 15 * units::um, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(zones.sun_eccentricity == 14.5 * units::um, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(zones.ring_eccentricity == 25 * units::um, boost::test_tools::tolerance(1e-12));
  BOOST_TEST((zones.within == dynamics::WithinZone::normal));
  // A better sun, 28.5 / 2 -> 14 µm, and a worse ring; the planets have no class.
  const auto own =
      zones_of("[tolerances]\nsun_accuracy_class = 4\nring_accuracy_class = 7\nplanet_pin_position_um = 30\n");
  BOOST_TEST(own.sun_eccentricity == 7 * units::um, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(own.planet_eccentricity == 0);
  BOOST_TEST(own.ring_eccentricity > 2 * own.sun_eccentricity);
  const auto mixed = zones_of("[tolerances]\naccuracy_class = 6\nsun_accuracy_class = 4\n");
  BOOST_TEST(mixed.sun_eccentricity == own.sun_eccentricity);
  BOOST_TEST(mixed.planet_eccentricity == zones.planet_eccentricity);
  const auto pins = zones_of("[tolerances]\nplanet_pin_position_um = 30\ndistribution = \"uniform\"\n");
  BOOST_TEST(pins.sun_eccentricity == 0);
  BOOST_TEST((pins.within == dynamics::WithinZone::uniform));
}

BOOST_AUTO_TEST_CASE(results_files_and_report) {
  const test::TemporaryFolder folder("tolerances");
  const auto text = test::quick_scene() + table;
  const auto result = run_toleranced(text, folder.path());
  BOOST_TEST_REQUIRE(result.rings.front().tolerances);
  const auto& sharing = result.rings.front().tolerances->sharing;
  BOOST_TEST(sharing.torque_shares == (std::vector<double>{0.25, 0.5, 0.75, 1, 1.25}),
             boost::test_tools::per_element());
  for (std::size_t i = 0; i < sharing.quantiles.size(); ++i) {
    BOOST_TEST(sharing.quantiles[i].p50.value < sharing.quantiles[i].p95.value);
    if (i > 0) BOOST_TEST(sharing.quantiles[i].p95.value < sharing.quantiles[i - 1].p95.value);  // heavier: more even
  }
  const auto json = nlohmann::json::parse(read_file(folder.path() / "summary.json"));
  const auto& ring = json["rings"]["held"];
  BOOST_TEST(ring["load_sharing_of_assemblies"]["by_torque"][3]["p95"]["value"].get<double>() ==
             sharing.quantiles[3].p95.value);
  BOOST_TEST(ring["load_sharing_of_assemblies"]["contributions"][0]["tolerance"] == "planet_pin_position");
  const auto csv = Csv::read(folder.path() / "held/dynamics/assemblies.csv");
  BOOST_TEST(csv.rows.size() == 200U);
  const auto figures = read_file(folder.path() / "figures.csv");
  BOOST_TEST(figures.find("load_sharing_of_assemblies_p95") != std::string::npos);
  const auto page = read_file(folder.path() / "report.html");
  BOOST_TEST(page.find("Load sharing of assemblies within the tolerances") != std::string::npos);
  BOOST_TEST(page.find("planet pins within ⌀ 40 µm") != std::string::npos);
  BOOST_TEST(page.find("Standards tabulate 1.3 to 1.35 for 5 planets") != std::string::npos);
  // The error of P95: the interval of 200 draws, and that of the stiffness.
  const auto p95 = result.rings.front().tolerances->figure(&dynamics::SharingQuantiles::p95, sharing.nominal());
  BOOST_TEST(p95.error >= sharing.quantiles[3].p95.high - p95.value);
  // Another run computes nothing again; another seed does.
  const auto again = run_toleranced(text, folder.path());
  BOOST_TEST(read_file(folder.path() / "held/dynamics/tolerance_sharing.csv").find("load_sharing_p95") !=
             std::string::npos);
  BOOST_TEST((again.rings.front().tolerances->sharing.factors == sharing.factors));
  const auto other = run_toleranced(text + "seed = 2\n", folder.path());
  BOOST_TEST((other.rings.front().tolerances->sharing.factors != sharing.factors));
}

BOOST_AUTO_TEST_CASE(bad_tolerances_are_refused) {
  const auto scene = test::quick_scene();
  BOOST_TEST(message_of(scene + "[tolerances]\nassemblies = 200\n").find("has no tolerance to draw within") !=
             std::string::npos);
  BOOST_TEST(message_of(scene + "[tolerances]\naccuracy_class = 12\n").find("12") != std::string::npos);
  BOOST_TEST(message_of(scene + "[tolerances]\naccuracy_class = 6\nassemblies = 5\n").find("100") != std::string::npos);
  BOOST_TEST(message_of(scene + table) == "");
  // Found by `check`, before anything is solved.
  BOOST_TEST(message_of(scene + "[tolerances]\nplanet_pin_position_um = 9000\n").find("of the module") !=
             std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
