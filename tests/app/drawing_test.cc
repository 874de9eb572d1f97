#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "app/model/gear_system.h"
#include "app/scene/new_scene.h"
#include "app/scene/scene_files.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/units.h"
#include "geometry/measurements.h"
#include "tests/app/scenes.h"

/// Drawing data of scenes, and profile shifts that follow from them.
namespace annulus {

namespace {

using app::Scene;

Scene parsed(const std::string& text) { return app::parse_scene(text, "scene.toml"); }

const geometry::Gear& gear_named(const app::DrawingData& data, const std::string& name) {
  for (const auto& g : data.gears)
    if (g.name == name) return g.gear;
  throw InternalError("no gear " + name);
}

void check_refused(const std::string& text, const std::string& words) {
  const auto says = [&](const Error& error) {
    const std::string what = error.what();
    BOOST_TEST(what.find(words) != std::string::npos, what);
    return what.find(words) != std::string::npos;
  };
  BOOST_CHECK_EXCEPTION((void)parsed(text), InputError, says);
}

/// The quick scene, where the shift of one gear follows from something else.
std::string with_shift_from(const std::string& given, const std::string& instead) {
  return test::replaced(test::quick_scene(), given, instead);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(drawing)

// Printed in the report of this stage: spans to a micrometre, diameters, contact ratios, paths of contact.
BOOST_AUTO_TEST_CASE(a_published_stage_has_its_printed_dimensions) {
  const auto scene = app::read_scene(ANNULUS_SOURCE_DIR "/data/cases/nrel_5mw_first_stage/first_stage.toml");
  const auto json = app::drawing_json(app::make_system(scene)->drawing());
  const auto near = [](const Json& value, double printed, double digit) {
    BOOST_TEST(std::abs(value.get<double>() - printed) <= digit, value.get<double>() << " against " << printed);
  };
  const auto &gears = json.at("gears"), &pairs = json.at("pairs");
  // The last digit, and 2 x 5e-5 m_n sin(alpha) = 1.5 um of profile shifts of four digits.
  constexpr double span = 2e-3;
  near(gears.at("sun").at("span_mm"), 363.082, span);
  near(gears.at("planet").at("span_mm"), 367.520, span);
  BOOST_TEST(gears.at("sun").at("span_teeth") == 3);
  const auto& ring = gears.at("ring '" + planetary(scene).rings.front().name + "'");
  near(ring.at("span_mm"), 1047.070, span);
  BOOST_TEST(ring.at("span_teeth") == 8);
  near(ring.at("base_diameter_mm"), 2368.025, 1e-3);
  const auto &sun_mesh = pairs.at("planet and sun"),
             &ring_mesh = pairs.at("planet and ring '" + planetary(scene).rings.front().name + "'");
  near(sun_mesh.at("contact_ratio"), 1.115, 5e-4);
  near(ring_mesh.at("contact_ratio"), 1.278, 5e-4);
  near(sun_mesh.at("path_of_contact_mm"), 148.093, 1e-3);
  near(ring_mesh.at("path_of_contact_mm"), 169.815, 1e-3);
  near(sun_mesh.at("working_pressure_angle_deg"), 28.118, 5e-4);
  near(ring_mesh.at("working_pressure_angle_deg"), 17.161, 5e-4);
}

BOOST_AUTO_TEST_CASE(shifts_follow_from_the_centre_distance_and_the_mate) {
  const auto scene = parsed(
      test::replaced(with_shift_from("profile_shift = 0.7608", "profile_shift_from = \"centre_distance\""),
                     "profile_shift = 0.1516", "profile_shift_from = \"centre_distance\"\nnormal_backlash_um = 120"));
  // Printed shifts of four digits leave some tenths of a micrometre of backlash.
  BOOST_TEST(std::abs(sun_and_planets(scene).sun.profile_shift - 0.7608) < 1e-4);
  const auto data = app::make_system(scene)->drawing();
  BOOST_TEST(std::abs(data.pairs[0].pair.normal_backlash()) < 1e-12);
  BOOST_TEST(std::abs(data.pairs[1].pair.normal_backlash() - 120e-6) < 1e-12);
  const auto* input = scene.find("sun.profile_shift", 0);
  BOOST_TEST((input && input->origin == app::Origin::derived));
}

BOOST_AUTO_TEST_CASE(shifts_follow_from_measurements) {
  const auto nominal = app::make_system(parsed(test::quick_scene()))->drawing();
  const auto& sun = gear_named(nominal, "sun");
  const double pin = 8e-3;
  for (const auto& keys : {fmt::format("profile_shift_from = \"span\"\nspan_teeth = 7\nspan_mm = {:.17g}",
                                       sun.base_tangent_length(7) / units::mm),
                           fmt::format("profile_shift_from = \"pins\"\nmeasuring_pin_mm = 8\nover_pins_mm = {:.17g}",
                                       geometry::dimension_over_pins(sun, pin) / units::mm)}) {
    const auto scene = parsed(with_shift_from("profile_shift = 0.7608", keys));
    BOOST_TEST(std::abs(sun_and_planets(scene).sun.profile_shift - 0.7608) < 1e-10);
  }
  // Both circles are the ones printed; the sun's shift follows from its root circle with a dedendum of 1.25 modules.
  const auto text = with_shift_from("profile_shift = 0.7608", "profile_shift_from = \"root_diameter\"");
  check_refused(text, "sun.profile_shift_from = root_diameter: needs sun.root_diameter_mm");
}

BOOST_AUTO_TEST_CASE(shifts_that_lead_nowhere_are_refused) {
  check_refused(test::replaced(with_shift_from("profile_shift = 0.7608", "profile_shift_from = \"centre_distance\""),
                               "profile_shift = 0.7361", "profile_shift_from = \"centre_distance\""),
                "needs the profile shift of the planet, which follows from the centre distance too");
  check_refused(
      with_shift_from("profile_shift = 0.7608", "profile_shift_from = \"span\"\nspan_teeth = 7\nspan_mm = 90"),
      "gives a profile shift of");
  check_refused(with_shift_from("profile_shift = 0.7608", "profile_shift = 0.7608\nprofile_shift_from = \"span\""),
                "profile_shift");
  check_refused(with_shift_from("profile_shift = 0.7608\n", ""), "sun.profile_shift");
}

// 24/36/96 without shifts: a ring with an addendum of one module would reach below the involutes of the planets.
BOOST_AUTO_TEST_CASE(a_textbook_set_is_not_refused_by_its_own_defaults) {
  auto text = read_file(ANNULUS_SOURCE_DIR "/data/scenes/minimal.toml");
  text = test::replaced(text, "planet = { teeth = 24", "planet = { teeth = 36");
  text = test::replaced(text, "teeth = 72", "teeth = 96");
  text = test::replaced(text, "centre_distance_mm = 96", "centre_distance_mm = 120");
  text = test::replaced(text, "tip_diameter_mm = 282\n", "");
  const auto scene = parsed(text);
  BOOST_CHECK_NO_THROW(app::check_stage(scene));
  const auto data = app::make_system(scene)->drawing();
  const auto& pair = data.pairs.back().pair;
  const double addendum = (pair.wheel().reference_radius() - pair.wheel().tip_radius()) / 4e-3;
  BOOST_TEST(addendum < 1.0);
  BOOST_TEST(addendum > 0.8);
  // The tip meets the start of the involute, within the micrometre to which it is rounded.
  const double form = std::sqrt(std::pow(pair.pinion().form_radius(), 2) - std::pow(pair.pinion().base_radius(), 2));
  BOOST_TEST(pair.roll_length_low() >= form);
  BOOST_TEST(pair.roll_length_low() - form < 5e-6);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
