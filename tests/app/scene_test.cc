#include "app/scene/scene.h"

#include <fmt/format.h>
#include <algorithm>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <iterator>

#include "app/model/gear_system.h"
#include "app/scene/example_scenes.h"
#include "app/scene/overrides.h"
#include "app/scene/scene_files.h"
#include "app/scene/scene_schema.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/stage_geometry.h"
#include "core/files.h"
#include "core/units.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

std::vector<app::Problem> problems_of(const std::string& text) {
  try {
    (void)app::parse_scene(text, "scene.toml");
  } catch (const app::SceneError& error) {
    return error.problems();
  }
  return {};
}

/// The scene with one change must be refused with one problem that holds all the given words.
void check_refused(const std::string& what, const std::string& by, const std::vector<std::string>& words) {
  const auto problems = problems_of(test::replaced(test::quick_scene(), what, by));
  BOOST_TEST_REQUIRE(problems.size() == 1U, by << ": " << problems.size() << " problems");
  for (const auto& word : words) {
    BOOST_TEST(problems.front().message.find(word) != std::string::npos, problems.front().message << " lacks " << word);
  }
}

/// The quick scene with another structure of its ring, whose keys follow.
std::string ring_with(const std::string& structure, const std::string& keys) {
  return test::replaced(test::quick_scene(), "structure = \"traditional\"",
                        "structure = \"" + structure + "\"\n" + keys);
}

int line_of(const std::string& text, const std::string& what) {
  const auto head = text.substr(0, text.find(what));
  return 1 + static_cast<int>(std::count(head.begin(), head.end(), '\n'));
}

/// This ring must be refused with one problem at the line of `key`, holding all the given words.
void check_ring_refused(const std::string& structure, const std::string& keys, const std::string& key,
                        const std::vector<std::string>& words) {
  const auto text = ring_with(structure, keys);
  const auto problems = problems_of(text);
  BOOST_TEST_REQUIRE(problems.size() == 1U, keys << ": " << problems.size() << " problems");
  BOOST_TEST(problems.front().line == line_of(text, key), key << ": line " << problems.front().line);
  for (const auto& word : words)
    BOOST_TEST(problems.front().message.find(word) != std::string::npos, problems.front().message << " lacks " << word);
}

const app::Input& input(const app::Scene& scene, const std::string& key) {
  for (const auto& i : scene.inputs) {
    if (i.key == key) return i;
  }
  throw std::logic_error(key);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(scene)

BOOST_AUTO_TEST_CASE(values_are_si) {
  const auto scene = app::parse_scene(test::quick_scene(), "scene.toml");
  // One rounding of value x factor each.
  BOOST_TEST(scene.stage.module == 3.8e-3, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(scene.stage.pressure_angle == 22.5 * units::deg, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(*planetary(scene).stage.power == 2958.8e3, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(*planetary(scene).stage.sun_speed == 1128 * units::rpm, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(scene.material.youngs_modulus == 206e9, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(planetary(scene).errors.planet_eccentricity.at(1) == 36e-6, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(scene.dynamics->half_backlash == 50e-6, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(planetary(scene).rings.at(0).name == "held");
}

BOOST_AUTO_TEST_CASE(origins_and_defaults) {
  const auto scene = app::parse_scene(test::quick_scene(), "scene.toml");
  BOOST_CHECK(input(scene, "stage.module_mm").origin == app::Origin::scene);
  BOOST_CHECK(input(scene, "material.poisson_ratio").origin == app::Origin::default_value);
  BOOST_TEST(scene.material.poisson_ratio == 0.3);
  BOOST_TEST(planetary(scene).errors.planet_pin_position.size() == 5U);  // an absent list becomes zeros
  BOOST_TEST(std::isinf(planetary(scene).supports.ring));                // an absent support is rigid
  BOOST_TEST(!planetary(scene).supports.sun_torsional.has_value());
}

BOOST_AUTO_TEST_CASE(unknown_key_has_line_and_nearest_key) {
  const auto text = test::replaced(test::quick_scene(), "pressure_angle_deg = 22.5", "presure_angle_deg = 22.5");
  const auto problems = problems_of(text);
  BOOST_TEST_REQUIRE(problems.size() == 2U);  // the unknown key, and the required one that is now missing
  BOOST_TEST(problems[1].line == line_of(text, "presure_angle_deg"));
  BOOST_TEST(problems[1].column == 1);
  BOOST_TEST(problems[1].message.find("did you mean stage.pressure_angle_deg?") != std::string::npos,
             problems[1].message);
  BOOST_TEST(problems[0].message.find("stage.pressure_angle_deg: is missing") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(wrong_values_are_refused_with_rule_and_unit) {
  check_refused("module_mm = 3.8", "module_mm = -3.8", {"stage.module_mm = -3.8", "0.05 <= value <= 100 mm"});
  check_refused("planets = 5", "planets = 5.5", {"stage.planets = 5.5", "a whole number"});
  check_refused("planets = 5", "planets = \"five\"", {"stage.planets = \"five\"", "a whole number"});
  check_refused("power_kW = 2958.8", "power_kW = nan", {"stage.power_kW"});
  check_refused("power_kW = 2958.8", "power_kW = inf", {"stage.power_kW"});
  check_refused("kind = \"planetary\"", "kind = \"planetry\"", {"did you mean \"planetary\"?"});
  check_refused("[15, 36, 17, 38, 19]", "[15, 36, 17, 38, \"x\"]",
                {"errors.planet_eccentricity_um", "list of numbers"});
  check_refused("title = \"Quick\"", "title = 3", {"title = 3", "text in quotes"});
}

BOOST_AUTO_TEST_CASE(rules_between_keys) {
  check_refused("sun_speed_rpm = 1128", "sun_speed_rpm = 1128\ncarrier_speed_rpm = 257",
                {"carrier_speed_rpm", "is given beside stage.sun_speed_rpm"});
  check_refused("sun_speed_rpm = 1128\n", "", {"sun_speed_rpm", "carrier_speed_rpm"});
  check_refused("[15, 36, 17, 38, 19]", "[15, 36, 17]", {"3 values for 5 planets"});
  check_refused("outside_diameter_mm = 663.6", "outside_diameter_mm = 663.6\nrim_thickness_mm = 20",
                {"rim_thickness_mm", "either"});
  check_refused("outside_diameter_mm = 663.6\n", "", {"outside_diameter_mm", "rim_thickness_mm"});
  check_refused("outside_diameter_mm = 663.6", "outside_diameter_mm = 663.6\npins = 24", {"ring.pins", "pinned"});
  check_refused("name = \"held\"", "name = \"a/b\"", {"ring.name", "folder"});
  check_refused("name = \"held\"", "name = \"..\"", {"ring.name", "folder"});
  for (const auto* own : {"mesh", "cache", "pictures", "report.html", "stiffness_sun_planet.csv"})
    check_refused("name = \"held\"", fmt::format("name = \"{}\"", own), {"ring.name", "that a run writes itself"});
  check_refused("ripple = 0.2258", "ripple = 1.5", {"mesh.sun_planet.ripple", "negative"});
  check_refused("ripple = 0.2258\n", "", {"mesh.sun_planet.ripple", "required"});
  check_refused("mass_kg = 66\n", "", {"sun.mass_kg", "[dynamics]"});
  check_refused("stiffness = \"harmonic\"\nmean_N_per_m = 1.364e9\nripple = 0.2258\n", "stiffness = \"table\"\n",
                {"file"});
}

BOOST_AUTO_TEST_CASE(computed_meshes_need_bores) {
  const auto text =
      test::replaced(test::quick_scene(), "stiffness = \"harmonic\"\nmean_N_per_m = 1.364e9\nripple = 0.2258\n",
                     "stiffness = \"computed\"\n");
  const auto problems = problems_of(text);
  BOOST_TEST_REQUIRE(problems.size() == 2U);
  BOOST_TEST(problems[0].message.find("sun.bore_diameter_mm") != std::string::npos);
  BOOST_TEST(problems[1].message.find("planet.bore_diameter_mm") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(ring_names_are_unique) {
  const std::string second =
      "[[ring]]\nname = \"held\"\nstructure = \"thin_walled\"\nteeth = 162\nprofile_shift = "
      "0.1516\noutside_diameter_mm = 663.6\n"
      "free_length_mm = 18\nsleeve_thickness_mm = 10.6\nmass_kg = 31\ninertia_kg_m2 = 3\n[errors]";
  check_refused("[errors]", second, {"ring.name = held", "more than one ring"});
}

BOOST_AUTO_TEST_CASE(what_is_not_available_is_said_so) {
  check_refused("[errors]", "[modes]\n[errors]", {"modes", "not yet available"});
}

BOOST_AUTO_TEST_CASE(what_belongs_to_another_kind_of_stage_is_said_so) {
  const auto problems = problems_of(test::replaced(test::quick_scene(), "kind = \"planetary\"", "kind = \"two_k_v\""));
  const auto told = [&](const std::string& what) {
    return std::any_of(problems.begin(), problems.end(), [&](const auto& p) {
      return p.line > 0 && p.message.find(what) != std::string::npos &&
             p.message.find("has no meaning for a stage of kind \"two_k_v\"; it belongs to planetary") !=
                 std::string::npos;
    });
  };
  BOOST_TEST(told("[[ring]]"));
  BOOST_TEST(told("[errors]"));
  BOOST_TEST(told("stage.power_kW = "));
}

BOOST_AUTO_TEST_CASE(pins_by_number_or_by_place) {
  const auto scene =
      app::parse_scene(ring_with("pinned", "pin_angles_deg = [0, 100, 250]\npin_diameter_mm = 15\n"), "s");
  const auto& ring = planetary(scene).rings.front();
  BOOST_TEST(ring.pin_count() == 3);
  BOOST_TEST(ring.pin_angles.at(1) == 100 * units::deg, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(!ring.housing_clearance.has_value());
  BOOST_TEST(*ring.pin_free_span == 0.0);
  BOOST_CHECK(input(scene, "ring.pin_clearance_um").origin == app::Origin::default_value);

  const std::string d = "pin_diameter_mm = 15\n";
  check_ring_refused("pinned", d, "[[ring]]", {"ring.pins", "pin_angles_deg", "is required"});
  check_ring_refused("pinned", d + "pins = 3\npin_angles_deg = [0, 120]", "pin_angles_deg", {"either pins"});
  check_ring_refused("pinned", d + "first_pin_angle_deg = 3\npin_angles_deg = [0, 120]", "first_pin_angle_deg",
                     {"first_pin_angle_deg = 3", "only with pins"});
  check_ring_refused("pinned", d + "pin_angles_deg = []", "pin_angles_deg",
                     {"at least one", "-360 <= each value <= 360 °"});
  check_ring_refused("pinned", d + "pin_angles_deg = [0, 400]", "pin_angles_deg",
                     {"[ 0, 400 ]", "value 2", "-360 <= each value <= 360 °"});
  check_ring_refused("bolted", d + "pin_angles_deg = [-90, 0, 270]", "pin_angles_deg",
                     {"pins 1 and 3 (-90° and 270°) have the same angular position"});
  // 2° on 663.6 mm are 11.58 mm, less than the diameter of 15 mm.
  check_ring_refused("pinned", d + "pin_angles_deg = [0, 90, 92]", "pin_angles_deg",
                     {"pins 2 and 3", "overlap", "11.58 mm", "pin_diameter_mm = 15"});
  check_ring_refused("pinned", d + "pins = 180", "pins = 180", {"ring.pins = 180", "overlap", "11.58 mm"});
  check_ring_refused("pinned", d + "pins = 0", "pins = 0", {"1 <= value <= 2000"});
  check_ring_refused("pinned", d + "pins = 6\npin_free_span_mm = -1", "pin_free_span_mm", {"0 <= value <= 1000 mm"});
  check_ring_refused("pinned", d + "pins = 6\nhousing_clearance_um = -1", "housing_clearance_um",
                     {"0 <= value <= 10000 µm"});
  check_ring_refused("bolted", d + "pins = 6\npin_clearance_um = 5", "pin_clearance_um",
                     {"only with structure = \"pinned\""});
  check_ring_refused("traditional", "housing_clearance_um = 5\n", "housing_clearance_um", {"\"pinned\" or \"bolted\""});
  check_ring_refused("thin_walled", "free_length_mm = 18\nsleeve_thickness_mm = 10\npin_angles_deg = [0]",
                     "pin_angles_deg", {"\"pinned\" or \"bolted\""});
}

BOOST_AUTO_TEST_CASE(a_single_pin_rests_in_a_bore) {
  const std::string keys = "pins = 1\npin_diameter_mm = 15\n";
  for (const auto* structure : {"pinned", "bolted"}) {
    const auto scene = app::parse_scene(ring_with(structure, keys), "s");
    BOOST_TEST_REQUIRE(planetary(scene).rings.front().housing_clearance.has_value());
    BOOST_TEST(*planetary(scene).rings.front().housing_clearance == 0.0);
    const auto& told = input(scene, "ring.housing_clearance_um");
    BOOST_CHECK(told.origin == app::Origin::default_value);
    BOOST_TEST(told.note.find("bore") != std::string::npos);
  }
  const auto given = app::parse_scene(ring_with("pinned", keys + "housing_clearance_um = 30\n"), "s");
  BOOST_TEST(*planetary(given).rings.front().housing_clearance == 30e-6, boost::test_tools::tolerance(1e-15));
}

BOOST_AUTO_TEST_CASE(splines) {
  const auto scene = app::parse_scene(ring_with("splined", "splines = 54\n"), "s");
  const auto& ring = planetary(scene).rings.front();
  BOOST_TEST(*ring.spline_flank_angle == 30 * units::deg, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(*ring.spline_clearance == 0.0);
  BOOST_TEST(!ring.spline_stiffness.has_value());
  check_ring_refused("splined", "", "[[ring]]", {"ring.splines", "is required"});
  check_ring_refused("splined", "splines = 2", "splines = 2", {"3 <= value <= 2000"});
  check_ring_refused("splined", "splines = 54\nspline_flank_angle_deg = 75", "spline_flank_angle_deg",
                     {"0 <= value <= 60 °"});
  check_ring_refused("splined", "splines = 54\nspline_stiffness_N_per_m = 0", "spline_stiffness_N_per_m",
                     {"0 < value <= 1e14 N/m"});
  check_ring_refused("splined", "splines = 54\npins = 24", "pins = 24", {"\"pinned\" or \"bolted\""});
  check_ring_refused("traditional", "splines = 54", "splines = 54", {"only with structure = \"splined\""});
}

BOOST_AUTO_TEST_CASE(clamped_rings) {
  const std::string clamp = "clamp_inner_diameter_mm = 640\n", number = "bolts = 36\n",
                    circle = "bolt_circle_diameter_mm = 652\n", diameter = "bolt_diameter_mm = 9\n";
  const std::string all = clamp + number + circle + diameter;
  const auto scene = app::parse_scene(ring_with("clamped", all), "s");
  const auto& ring = planetary(scene).rings.front();
  BOOST_TEST(*ring.clamp_inner_diameter == 0.64, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(*ring.first_bolt_angle == 0.0);
  BOOST_TEST(!ring.dowels.has_value());
  BOOST_CHECK_NO_THROW((void)app::parse_scene(ring_with("clamped", all + "dowels = 6\ndowel_diameter_mm = 8\n"), "s"));

  check_ring_refused("clamped", number + circle + diameter, "[[ring]]",
                     {"ring.clamp_inner_diameter_mm", "is required"});
  check_ring_refused("clamped", clamp + circle + diameter, "[[ring]]", {"ring.bolts", "is required"});
  check_ring_refused("traditional", clamp, "clamp_inner", {"only with structure = \"clamped\""});
  check_ring_refused("clamped", all + "pins = 24", "pins = 24", {"\"pinned\" or \"bolted\""});
  check_ring_refused("clamped", "clamp_inner_diameter_mm = 664\n" + number + circle + diameter, "clamp_inner",
                     {"smaller than the outside diameter", "value < 663.6 mm"});
  // A hole of 9 mm between 640 and 663.6 mm.
  check_ring_refused("clamped", clamp + number + "bolt_circle_diameter_mm = 645\n" + diameter, "bolt_circle",
                     {"649 mm <= value <= 654.6 mm"});
  // 1° on 652 mm are 5.69 mm.
  check_ring_refused("clamped", clamp + "bolts = 360\n" + circle + diameter, "bolts = 360",
                     {"overlap", "5.69 mm", "bolt_diameter_mm = 9"});
  check_ring_refused("clamped", all + "dowels = 4", "dowels = 4", {"needs ring.dowel_diameter_mm"});
  check_ring_refused("clamped", all + "dowels = 37\ndowel_diameter_mm = 8", "dowels = 37", {"value <= bolts = 36"});
  // Halfway between 200 bolts, 5.121 mm from either.
  check_ring_refused("clamped", clamp + "bolts = 200\n" + circle + diameter + "dowels = 4\ndowel_diameter_mm = 8",
                     "dowel_diameter_mm", {"5.121 mm away", "value <= 1.24"});
}

BOOST_AUTO_TEST_CASE(flanges_and_hoops_come_in_pairs) {
  const std::string sleeve = "free_length_mm = 18\nsleeve_thickness_mm = 10.6\n";
  const auto flange =
      app::parse_scene(ring_with("traditional", "flange_width_mm = 20\nflange_diameter_mm = 740\n"), "s");
  BOOST_TEST(*planetary(flange).rings.front().flange_diameter == 0.74, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(problems_of(ring_with("thin_walled", sleeve + "hoop_width_mm = 15\nhoop_thickness_mm = 15\n")).empty());
  check_ring_refused("traditional", "flange_width_mm = 20", "flange_width_mm",
                     {"flange_width_mm = 20", "flange_diameter_mm"});
  check_ring_refused("traditional", "flange_width_mm = 90\nflange_diameter_mm = 740", "flange_width_mm",
                     {"face width", "value <= 88 mm"});
  check_ring_refused("traditional", "flange_width_mm = 20\nflange_diameter_mm = 660", "flange_diameter_mm",
                     {"value > 663.6 mm"});
  check_ring_refused("bolted", "pins = 6\npin_diameter_mm = 15\nflange_width_mm = 20", "flange_width_mm",
                     {"traditional"});
  check_ring_refused("thin_walled", sleeve + "hoop_thickness_mm = 15", "hoop_thickness_mm", {"hoop_width_mm"});
  check_ring_refused("thin_walled", sleeve + "hoop_width_mm = 89\nhoop_thickness_mm = 15", "hoop_width_mm",
                     {"value <= 88 mm"});
  check_ring_refused("traditional", "hoop_width_mm = 5", "hoop_width_mm", {"thin_walled"});
}

BOOST_AUTO_TEST_CASE(plane_models_are_refused_where_the_face_width_matters) {
  const auto paper = [](const std::string& what, const std::string& by) {
    const std::string text = read_file(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_types.toml");
    return test::replaced(text, what, by);
  };
  for (const std::string fidelity : {"plane", "closed_form"}) {
    const auto forced = paper("accuracy = 0.01", "accuracy = 0.01\nmodel = \"" + fidelity + "\"");
    const auto problems = problems_of(forced);
    BOOST_TEST_REQUIRE(problems.size() == 1U);
    const auto& message = problems.front().message;
    BOOST_TEST(problems.front().line == line_of(forced, "model ="));
    BOOST_TEST(message.find("model = " + fidelity + ": ") == 0U, message);
    BOOST_TEST(message.find("'thin-walled'") != std::string::npos, message);
    BOOST_TEST(message.find("free end") != std::string::npos, message);
  }
  BOOST_TEST(problems_of(paper("accuracy = 0.01", "model = \"solid\"")).empty());
  const auto resolved = problems_of(paper("accuracy = 0.01", "model = \"resolved\""));
  BOOST_TEST_REQUIRE(resolved.size() == 1U);
  BOOST_TEST(resolved.front().message.find("'pinned'") != std::string::npos, resolved.front().message);
  // Helical teeth push the rings along their axis, whatever holds them.
  BOOST_TEST(problems_of(paper("planets = 5", "planets = 5\nhelix_angle_deg = 12")).empty());
  // The planet's lead touches the sun mesh and every ring mesh.
  const auto lead = test::replaced(paper("accuracy = 0.01", "model = \"closed_form\""), "bore_diameter_mm = 172",
                                   "bore_diameter_mm = 172\nlead_crowning_um = 5");
  const auto problems = problems_of(lead);
  BOOST_TEST_REQUIRE(problems.size() == 4U);
  for (const auto& p : problems) BOOST_TEST(p.message.find("lead of the planet") != std::string::npos, p.message);
  const auto misaligned = problems_of(test::replaced(paper("accuracy = 0.01", "model = \"plane\""), "[errors]",
                                                     "[errors]\nsun_planet_misalignment_um = 5"));
  BOOST_TEST_REQUIRE(misaligned.size() == 2U);  // the sun mesh, and the cantilever as ever
  BOOST_TEST(misaligned.front().message.find("misaligned") != std::string::npos, misaligned.front().message);
}

BOOST_AUTO_TEST_CASE(misplaced_keys_and_tables) {
  check_refused("planets = 5", "planets = 5\nteeth = 3", {"stage.teeth", "[sun]", "[planet]", "[[ring]]"});
  check_refused("[errors]", "[suports]\n[errors]", {"suports: unknown table", "supports"});
  check_refused("[errors]", "[mesh.ring]\n[errors]", {"mesh.ring", "mesh.ring_planet"});
}

BOOST_AUTO_TEST_CASE(all_problems_are_collected_in_file_order) {
  auto text = test::replaced(test::quick_scene(), "module_mm = 3.8", "module_mm = -1");
  text = test::replaced(text, "youngs_modulus_GPa = 206", "youngs_modulus_GPa = \"x\"");
  text = test::replaced(text, "teeth = 55", "teeth = 1");
  text = test::replaced(text, "[15, 36, 17, 38, 19]", "[15]");
  const auto problems = problems_of(text);
  BOOST_TEST_REQUIRE(problems.size() == 4U);
  for (std::size_t i = 1; i < problems.size(); ++i) BOOST_TEST(problems[i].line > problems[i - 1].line);
  for (const auto& p : problems) BOOST_TEST(p.line > 0);
}

BOOST_AUTO_TEST_CASE(assumed_inputs) {
  const auto scene =
      app::parse_scene(test::quick_scene() + "[assumed]\nsupports.sun_N_per_m = \"not printed\"\n", "scene.toml");
  BOOST_TEST(input(scene, "supports.sun_N_per_m").assumed == "not printed");
  const auto refused = [](const std::string& line) {
    return problems_of(test::quick_scene() + "[assumed]\n" + line + "\n");
  };
  BOOST_TEST_REQUIRE(refused("supports.sn_N_per_m = \"x\"").size() == 1U);
  BOOST_TEST(refused("supports.sn_N_per_m = \"x\"")[0].message.find("supports.sun_N_per_m") != std::string::npos);
  BOOST_TEST(refused("supports.sun_N_per_m = 3").size() == 1U);      // the reason is a text
  BOOST_TEST(refused("sun.bore_diameter_mm = \"x\"").size() == 1U);  // not set in this scene
}

BOOST_AUTO_TEST_CASE(a_load_is_stated_once) {
  const auto with_load = [](const std::string& load) {
    return test::replaced(test::quick_scene(), "power_kW = 2958.8\n", load);
  };
  const double torque =
      app::make_geometry(app::parse_scene(test::quick_scene(), "scene.toml")).operating_point.sun_torque;
  const auto by_torque = app::parse_scene(with_load(fmt::format("sun_torque_Nm = {:.17g}\n", torque)), "scene.toml");
  const auto by_carrier = app::parse_scene(
      with_load(fmt::format("carrier_torque_Nm = {:.17g}\n", torque * (1 + 162.0 / 48))), "scene.toml");
  for (const auto& scene : {by_torque, by_carrier})
    BOOST_TEST(app::make_geometry(scene).operating_point.power == 2958.8e3, boost::test_tools::tolerance(1e-12));
  // A torque stays where the speed changes; a power does not.
  const auto faster = app::with_overrides(by_torque, {{"stage.sun_speed_rpm", 2256}});
  BOOST_TEST(app::make_geometry(faster).operating_point.sun_torque == torque, boost::test_tools::tolerance(1e-12));
  const auto none = problems_of(with_load(""));
  BOOST_TEST_REQUIRE(none.size() == 1U);
  BOOST_TEST(none[0].message ==
             "stage.power_kW: one of power_kW, sun_torque_Nm, carrier_torque_Nm, ring_torque_Nm is required");
  const auto two = problems_of(with_load("power_kW = 2958.8\nsun_torque_Nm = 3\n"));
  BOOST_TEST_REQUIRE(two.size() == 1U);
  BOOST_TEST(two[0].message.find("is given beside power_kW") != std::string::npos, two[0].message);
  // A word without its body finds its key; tables of other kinds are no advice.
  const auto word = problems_of(with_load("power_kW = 2958.8\ntorque_Nm = 3\n"));
  BOOST_TEST_REQUIRE(word.size() == 1U);
  BOOST_TEST(word[0].message.find("did you mean stage.sun_torque_Nm?") != std::string::npos, word[0].message);
}

BOOST_AUTO_TEST_CASE(every_gear_that_cannot_exist_is_reported) {
  const auto text =
      test::replaced(test::replaced(test::quick_scene(), "profile_shift = 0.7608", "profile_shift = 2.95"),
                     "profile_shift = 0.7361", "profile_shift = 2.9");
  const auto scene = app::parse_scene(text, "scene.toml");
  BOOST_CHECK_EXCEPTION(app::check_stage(scene), GeometryError, [](const auto& error) {
    const std::string what = error.what();
    const auto lines = std::count(what.begin(), what.end(), '\n') + 1;
    BOOST_TEST(lines == 2, what);
    BOOST_TEST(what.find(": sun: ") != std::string::npos, what);
    BOOST_TEST(what.find(": planet: ") != std::string::npos, what);
    return lines == 2;
  });
}

BOOST_AUTO_TEST_CASE(broken_toml_has_a_place) {
  const auto problems = problems_of("[stage]\nplanets = = 5\n");
  BOOST_TEST_REQUIRE(problems.size() == 1U);
  BOOST_TEST(problems[0].line == 2);
  BOOST_CHECK_THROW((void)app::read_scene("/no/such/file.toml"), InputError);
}

BOOST_AUTO_TEST_CASE(every_key_is_documented) {
  for (const auto& table : app::schema()) {
    BOOST_TEST(!table.meaning.empty());
    for (const auto& p : table.parameters) {
      BOOST_TEST(p.meaning.size() > 3U, p.key());
      // What an absent key means has to be documented, and so has the reason of a default (a title needs none).
      const bool needed = !p.required_if.empty() || !p.required_for.empty();
      if (p.presence == app::Parameter::Presence::optional) BOOST_TEST((needed || !p.note.empty()), p.key());
      if (p.presence == app::Parameter::Presence::defaulted && p.name != "title") BOOST_TEST(!p.note.empty(), p.key());
      if (p.kind == app::Parameter::Kind::real && p.presence == app::Parameter::Presence::required)
        BOOST_TEST(!p.range_text().empty(), p.key());
    }
  }
  BOOST_TEST(app::explain(*app::find_parameter("stage.module_mm")).find("mm") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_ring_without_a_name_is_one_problem) {
  const auto problems = problems_of(test::replaced(test::small_stage(), "name = \"ring\"\n", ""));
  BOOST_TEST_REQUIRE(problems.size() == 1U);
  BOOST_TEST(problems.front().message.find("ring.name: is missing for ring '1'") != std::string::npos,
             problems.front().message);
}

BOOST_AUTO_TEST_CASE(the_scene_reference_is_up_to_date) {
  const std::string text = read_file(std::string(ANNULUS_SOURCE_DIR) + "/docs/scene.md");
  BOOST_TEST((text == app::scene_reference()), "run: annulus explain --markdown > docs/scene.md");
}

BOOST_AUTO_TEST_CASE(shipped_scenes_are_good) {
  int scenes = 0;
  for (const auto& file : std::filesystem::directory_iterator(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes")) {
    if (file.path().extension() != ".toml") continue;
    BOOST_CHECK_NO_THROW((void)app::read_scene(file.path()));
    ++scenes;
  }
  BOOST_TEST(scenes > 0);
}

BOOST_AUTO_TEST_CASE(every_example_is_a_scene) {
  BOOST_TEST(app::example_scenes().size() > 15U);
  for (const auto& [name, text] : app::example_scenes()) {
    BOOST_TEST_CONTEXT(name) {
      const auto start = app::example_to_start_from(name);
      BOOST_CHECK_NO_THROW((void)app::parse_scene(start, "scene.toml"));
      BOOST_TEST(start.find("\nreference") == std::string::npos);
    }
  }
  BOOST_CHECK_EXCEPTION((void)app::example_scene("grc_750kw/planetary_stag"), InputError, [](const InputError& error) {
    return std::string(error.what()).find("did you mean grc_750kw/planetary_stage?") != std::string::npos;
  });
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
