#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <string>

#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/strain_gauges.h"
#include "core/errors.h"
#include "core/units.h"
#include "tests/app/scene_refusal.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

/// [[strain_gauge]] from the scene to its files.
BOOST_AUTO_TEST_SUITE(strain_gauges)

using namespace annulus;

namespace {

std::string gauge(const std::string& name, const std::string& place, double angle_deg, const std::string& more = "") {
  return fmt::format("[[strain_gauge]]\nname = \"{}\"\nplace = \"{}\"\nangle_deg = {}\nlength_mm = 1\n{}", name, place,
                     angle_deg, more);
}

/// The small stage on bolts that pull as well, without dynamics.
std::string bolted(const std::string& gauges) {
  auto text = test::small_stage();
  text = text.substr(0, text.find("[errors]"));
  text = test::replaced(text, "\"traditional\"", "\"bolted\"\npins = 8\npin_diameter_mm = 12\nfirst_pin_angle_deg = 7");
  return "accuracy = 0.03\n" + text + gauges;
}

struct Readings {
  app::GaugeReadings readings;
  Csv alone;
};
Readings readings_of(const std::string& text, const std::filesystem::path& out) {
  const auto scene = app::parse_scene(text, "scene.toml");
  app::RunOptions options;
  options.out = out;
  options.for_study = true;
  const auto geometry = app::make_geometry(scene);
  const auto mesh = app::mesh_stiffness(scene, geometry, app::ring_mesh_model(scene, geometry, 0), options);
  return {app::gauge_readings(scene, geometry.rings.front().set, mesh).value(), mesh.gauges};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_strains_of_all_planets_add_up) {
  const test::TemporaryFolder folder("strain_gauges");
  const auto text = bolted(gauge("root", "root", 37.6, "offset_mm = 0.4\n") + gauge("outside", "outside", 100));
  const auto [readings, alone] = readings_of(text, folder.path());
  BOOST_REQUIRE(readings.gauges.size() == 2U);
  for (std::size_t g = 0; g < 2; ++g) {
    const auto& strain = readings.gauges[g].strain;
    const auto column = alone.column(fmt::format("gauge_{}_um_per_m", g + 1));
    double of_one = 0;
    for (const auto& row : alone.rows) of_one += row[column] * 1e-6;
    const double of_all = std::accumulate(strain.begin(), strain.end(), 0.0);
    const double scale = readings.gauges[g].range() * static_cast<double>(strain.size());
    BOOST_TEST(std::abs(of_all - 4 * of_one) <= 1e-6 * scale);  // rounding of the table to six digits
    // Four equal planets 18 teeth apart: nothing changes when each takes the place of the next.
    const std::size_t quarter = strain.size() / 4;
    for (std::size_t i = 0; i < strain.size(); ++i)
      BOOST_REQUIRE(std::abs(strain[i] - strain[(i + quarter) % strain.size()]) <= 1e-5 * readings.gauges[g].range());
    // It shows most when a planet passes.
    const auto most =
        std::max_element(strain.begin(), strain.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    const double at = readings.angle[static_cast<std::size_t>(most - strain.begin())] / units::deg;
    const double off = std::remainder(at - (g == 0 ? 37.6 : 100), 90);
    BOOST_TEST(std::abs(off) < 3 * 5.0);  // teeth are 5 degrees apart
    BOOST_TEST(readings.gauges[g].error > 0);
    BOOST_TEST(readings.gauges[g].error < 0.5 * readings.gauges[g].range());
  }
  BOOST_TEST(!readings.face_load_factor(0));
  const auto csv = app::to_csv(readings, app::GaugeFrame::ring);
  BOOST_TEST(csv.rows.size() == alone.rows.size());
  BOOST_TEST(csv.header_value("gauge_2").value() == "outside");
}

BOOST_AUTO_TEST_CASE(a_stage_that_turns_the_other_way_has_the_mirrored_gauges) {
  const test::TemporaryFolder folder("mirrored_gauges");
  const auto text = bolted(gauge("root", "root", 37.6, "offset_mm = 0.4\n"));
  auto mirrored = bolted(gauge("root", "root", -37.6, "offset_mm = -0.4\n"));
  mirrored = test::replaced(mirrored, "first_pin_angle_deg = 7", "first_pin_angle_deg = -7");
  mirrored = test::replaced(mirrored, "sun_speed_rpm = 1500", "sun_speed_rpm = -1500");
  const auto one = readings_of(text, folder.path() / "one").readings.gauges.front(),
             other = readings_of(mirrored, folder.path() / "other").readings.gauges.front();
  BOOST_TEST(one.largest == other.largest, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(one.smallest == other.smallest, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(gauges_choose_the_model) {
  const auto model = [](const std::string& text) {
    const auto scene = app::parse_scene(text, "scene.toml");
    return app::ring_mesh_model(scene, app::make_geometry(scene), 0).fidelity;
  };
  // Formulas would do for the stiffness.
  auto plain = test::small_stage();
  plain = "accuracy = 0.1\n" + plain.substr(0, plain.find("[errors]"));
  BOOST_TEST(model(plain) == "closed_form");
  BOOST_TEST(model(plain + gauge("a", "root", 2)) == "plane");
  BOOST_TEST(model(plain + gauge("a", "root", 2, "axial_positions_mm = [-20, 20]\n")) == "solid");
  BOOST_TEST(model(plain + gauge("a", "root", 2, "axial_positions_mm = [0]\n")) == "plane");
  BOOST_TEST(model(plain + gauge("a", "root", 2, "direction = \"axial\"\n")) == "solid");
}

BOOST_AUTO_TEST_CASE(what_no_gauge_can_show_is_refused) {
  const auto with = [](const std::string& gauges) {
    auto text = test::small_stage();
    return text.substr(0, text.find("[errors]")) + gauges;
  };
  const auto says = [&](const std::string& text, const std::string& words) {
    const auto message = test::scene_refusal(text);
    BOOST_TEST(message.find(words) != std::string::npos, message);
  };
  says(with(gauge("a", "root", 45)), "is the middle of a tooth");
  says(with(gauge("", "root", 2)), "not empty");
  says("model = \"resolved\"\n" + with(gauge("a", "root", 2)), "no whole ring");
  says(with(gauge("a", "outside", 0)), "whose outside is fixed");
  says(with(gauge("a", "root", 2, "ring = \"other\"\n")), "the name of no ring");
  says(with(gauge("a", "root", 2) + gauge("a", "root", 8)), "more than one gauge");
  says(with("[mesh.ring_planet]\nstiffness = \"constant\"\nmean_N_per_m = 1e9\n" + gauge("a", "root", 2)),
       "no ring that is strained");
  says("model = \"plane\"\n" + with(gauge("a", "root", 2, "axial_positions_mm = [-20, 20]\n")),
       "strain gauges stand at places along the face width");
  says(bolted(gauge("a", "outside", 0, "offset_mm = 2\n")), "strain_gauge.offset_mm");
}

BOOST_AUTO_TEST_SUITE_END()
