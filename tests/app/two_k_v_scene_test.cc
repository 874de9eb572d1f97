#include <boost/test/unit_test.hpp>
#include <cmath>

#include "app/model/gear_system.h"
#include "app/scene/overrides.h"
#include "app/scene/scene_schema.h"
#include "app/systems/shared/sun_planet_input.h"
#include "app/systems/two_k_v/two_k_v_input.h"
#include "app/systems/two_k_v/two_k_v_model.h"
#include "core/units.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"

namespace annulus {

namespace {

app::Scene parse(const std::string& text) {
  auto scene = app::parse_scene(text, "reducer.toml");
  app::check_stage(scene);
  return scene;
}

/// The message with which a scene with `what` replaced is refused; empty when it is not.
std::string refusal(const std::string& what, const std::string& by) {
  try {
    (void)parse(test::replaced(test::reducer_scene(), what, by));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void refused(const std::string& what, const std::string& by, const std::string& where, const std::string& remedy) {
  const std::string message = refusal(what, by);
  BOOST_TEST_CONTEXT(what << " -> " << by << ": " << message) {
    BOOST_TEST(message.find(where) != std::string::npos);
    BOOST_TEST(message.find(remedy) != std::string::npos);
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(two_k_v_scene)

BOOST_AUTO_TEST_CASE(values_arrive_in_SI) {
  const auto scene = parse(test::reducer_scene());
  BOOST_TEST(two_k_v(scene).arc_gear.eccentricity == 0.9e-3, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(two_k_v(scene).arc_gear.count == 2);
  BOOST_TEST(*two_k_v(scene).crank.shaft == 3141.0);
  BOOST_TEST(two_k_v(scene).output.torque == 58.0);
  BOOST_TEST(two_k_v(scene).output.speed == 30 * units::rpm, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(std::isinf(two_k_v(scene).output.support));
  BOOST_TEST(two_k_v(scene).input.support == 0.0);
  const auto stage = app::two_k_v_kinematics(scene);
  BOOST_TEST(stage.ratio() == 103.0);
  BOOST_TEST(stage.sun_mesh_frequency() == 510.0, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(app::make_system(scene)->describe() == "2 cranks with a planet each, 2 arc gears on 30 pins, ratio 103");
}

BOOST_AUTO_TEST_CASE(keys_of_other_kinds_are_refused) {
  refused("planets = 2\n", "planets = 2\ncentre_distance_mm = 22\n", "reducer.toml:5",
          "no meaning for a stage of kind \"two_k_v\"");
  refused("[crank]", "[carrier]\nmass_kg = 1\n[crank]", "[carrier]", "planetary");
  refused("[mesh.arc_pins]", "[mesh.ring_planet]\nstiffness = \"constant\"\nmean_N_per_m = 1e8\n[mesh.arc_pins]",
          "mesh.ring_planet", "planetary");
  // And the other way round.
  try {
    (void)app::parse_scene(test::quick_scene() + "[crank]\ninertia_kg_m2 = 1\n", "scene.toml");
    BOOST_ERROR("[crank] in a planetary scene");
  } catch (const InputError& error) {
    BOOST_TEST(std::string(error.what()).find("it belongs to two_k_v") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(bad_values_are_refused_with_place_and_remedy) {
  // Ranges and types, from the declarations.
  refused("pins = 30", "pins = 3", "reducer.toml:24", "4 <= value <= 1000");
  refused("pins = 30", "pins = 30.5", "arc_gear.pins = 30.5", "whole number");
  refused("eccentricity_mm = 0.9", "eccentricity_mm = 0", "arc_gear.eccentricity_mm = 0", "0 < value");
  refused("torque_Nm = 58", "torque_Nm = -58", "output.torque_Nm", "0 < value");
  refused("speed_rpm = 30", "speed_rpm = 0", "output.speed_rpm", "0 < value");
  refused("shaft_Nm_per_rad = 536", "shaft_Nm_per_rad = 0", "input.shaft_Nm_per_rad", "0 < value");
  refused("support_Nm_per_rad = inf", "support_Nm_per_rad = -1", "output.support_Nm_per_rad", "0 <= value");
  refused("[output]\n", "[output]\nsuport_Nm_per_rad = 1\n", "output.suport_Nm_per_rad",
          "did you mean output.support_Nm_per_rad");
  refused("width_mm = 8\n", "width_mm = 8\napproach = \"hertz\"\n", "arc_gear.approach = \"hertz\"", "handbook");
  refused("stiffness = \"constant\"\nmean_N_per_m = 1.4e8", "stiffness = \"constant\"\ncompare = \"plane\"\n",
          "mesh.sun_planet.compare", "computed");
  // What is missing.
  refused("pins = 30\n", "", "arc_gear.pins", "is missing");
  refused("support_Nm_per_rad = inf\n", "", "output.support_Nm_per_rad", "is missing");
  refused("[crank]\ninertia_kg_m2 = 4.6e-7\nshaft_Nm_per_rad = 3141\nbearing_N_per_m = 1.5e8\n", "", "[crank]",
          "is missing");
  refused("inertia_kg_m2 = 8.405e-6\n", "", "input.inertia_kg_m2", "required by [dynamics]");
  refused("bearing_N_per_m = 1.500e8\n", "", "arc_gear.bearing_N_per_m", "required by [dynamics]");
  refused("mass_kg = 0.1083\n", "", "planet.mass_kg", "required by [dynamics]");
}

BOOST_AUTO_TEST_CASE(rules_between_keys) {
  refused("face_width_mm = 10\n", "face_width_mm = 10\nhelix_angle_deg = 12\n", "stage.helix_angle_deg = 12",
          "must be 0");
  refused("profile_shift = -0.45", "profile_shift = 0.1", "planet.profile_shift = 0.1", "must be -0.45");
  refused("inertia_kg_m2 = 9.2e-8", "inertia_kg_m2 = 9.2e-8\nmass_kg = 0.01", "sun.mass_kg = 0.01", "leave it out");
  refused("pin_circle_diameter_mm = 80", "pin_circle_diameter_mm = 50", "arc_gear.pin_circle_diameter_mm = 50",
          "larger than 2 × eccentricity × pins = 54 mm");
  refused("pin_diameter_mm = 4", "pin_diameter_mm = 9", "arc_gear.pin_diameter_mm = 9", "8.3623 mm apart");
  refused("arc_radius_mm = 2.2", "arc_radius_mm = 1.9", "arc_gear.arc_radius_mm = 1.9", "larger than the pin's radius");
  refused("width_mm = 8\n", "width_mm = 8\nclearance_um = 5\n", "arc_gear.clearance_um = 5", "half_backlash_um");
  refused("shaft_Nm_per_rad = 536", "shaft_Nm_per_rad = 536\nsupport_Nm_per_rad = inf", "output.support_Nm_per_rad",
          "leave input.support_Nm_per_rad out");
  refused("mean_N_per_m = 1.4e8", "mean_N_per_m = 1.4e8\ncompare = \"computed\"", "sun.bore_diameter_mm",
          "mesh.sun_planet.compare");
  refused("mean_N_per_m = 7.5e8", "mean_N_per_m = 7.5e8\nripple = 0.1", "mesh.arc_pins.ripple", "harmonic");
  refused("[mesh.arc_pins]\nstiffness = \"constant\"\nmean_N_per_m = 7.5e8",
          "[mesh.arc_pins]\nstiffness = \"computed\"\ncompare = \"computed\"", "mesh.arc_pins.compare", "is computed");
  refused("half_backlash_um = 0", "half_backlash_um = 0\nintegrator = \"runge_kutta_4\"", "dynamics.steps_per_cycle",
          "runge_kutta_4");
  refused("half_backlash_um = 0", "half_backlash_um = 0\nrim_coupling = \"none\"", "dynamics.rim_coupling",
          "planetary");
}

BOOST_AUTO_TEST_CASE(gears_that_cannot_be_are_refused) {
  refused("profile_shift = 0.45", "profile_shift = 0.0", "must be 0", "");
  const auto undercut = test::replaced(
      test::replaced(test::reducer_scene(), "profile_shift = 0.45", "profile_shift = 0"), "= -0.45", "= 0");
  BOOST_CHECK_THROW((void)parse(undercut), GeometryError);
  refused("planets = 2", "planets = 4", "stage.planets = 4", "take fewer");
  // Line contact no longer holds where the load is far too high.
  const auto crushed = test::replaced(test::replaced(test::reducer_scene(), "torque_Nm = 58", "torque_Nm = 1e8"),
                                      "[mesh.arc_pins]\nstiffness = \"constant\"\nmean_N_per_m = 7.5e8",
                                      "[mesh.arc_pins]\nstiffness = \"computed\"");
  BOOST_CHECK_THROW((void)parse(crushed), Error);
}

BOOST_AUTO_TEST_CASE(every_key_of_the_kind_can_be_varied) {
  const auto scene = parse(test::reducer_scene());
  const auto changed = app::with_overrides(scene, {{"crank.bearing_N_per_m", 2, true}, {"output.torque_Nm", 29}});
  BOOST_TEST(*two_k_v(changed).crank.bearing == 3e8);
  BOOST_TEST(two_k_v(changed).output.torque == 29.0);
  BOOST_CHECK_THROW((void)app::with_overrides(scene, {{"arc_gear.pin_diameter_mm", 9}}), InputError);
  for (const auto& table : app::schema())
    for (const auto& p : table.parameters)
      if (table.applies_to("two_k_v") && p.applies_to("two_k_v")) BOOST_TEST(!p.meaning.empty(), p.key());
}

BOOST_AUTO_TEST_CASE(a_comparison_computes_what_is_given) {
  auto text =
      test::replaced(test::reducer_scene(), "mean_N_per_m = 7.5e8", "mean_N_per_m = 7.5e8\ncompare = \"computed\"");
  const auto scene = parse(text);
  const auto other = app::compared_scene(scene);
  BOOST_REQUIRE(other.has_value());
  BOOST_TEST((two_k_v(*other).arc_pins.stiffness == app::StiffnessShape::computed));
  BOOST_TEST((sun_and_planets(*other).sun_planet.stiffness == app::StiffnessShape::constant));
  BOOST_TEST(!app::compared_scene(parse(test::reducer_scene())).has_value());
  // The table at the nominal load against the equilibrium of all pins.
  const auto result = app::arc_pins_result(*other);
  const auto stage = app::two_k_v_kinematics(scene);
  BOOST_TEST(result.table.loads()[result.nominal] == stage.mean_arc_mesh_force(), boost::test_tools::tolerance(1e-12));
  const auto position = dynamics::arc_position(*app::arc_tooth_mesh(scene), stage.arc_torque(), 0);
  BOOST_TEST(result.table.at(0, 0, static_cast<int>(result.nominal)).stiffness_secant == position.secant,
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(std::abs(result.contact_ratio - 14.5) <= 1);  // half of the pins
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
