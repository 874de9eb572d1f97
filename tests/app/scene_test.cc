#include "app/scene.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <iterator>

#include "app/scene_schema.h"
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

int line_of(const std::string& text, const std::string& what) {
  const auto head = text.substr(0, text.find(what));
  return 1 + static_cast<int>(std::count(head.begin(), head.end(), '\n'));
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
  BOOST_TEST(scene.stage.power == 2958.8e3, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(*scene.stage.sun_speed == 1128 * units::rpm, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(scene.material.youngs_modulus == 206e9, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(scene.errors.planet_eccentricity.at(1) == 36e-6, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(scene.dynamics->half_backlash == 50e-6, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(scene.rings.at(0).name == "held");
}

BOOST_AUTO_TEST_CASE(origins_and_defaults) {
  const auto scene = app::parse_scene(test::quick_scene(), "scene.toml");
  BOOST_CHECK(input(scene, "stage.module_mm").origin == app::Origin::scene);
  BOOST_CHECK(input(scene, "material.poisson_ratio").origin == app::Origin::default_value);
  BOOST_TEST(scene.material.poisson_ratio == 0.3);
  BOOST_TEST(scene.errors.planet_installation.size() == 5U);  // an absent list becomes zeros
  BOOST_TEST(std::isinf(scene.supports.ring));                // an absent support is rigid
  BOOST_TEST(scene.supports.sun_torsional == 0.0);
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
                {"carrier_speed_rpm", "either"});
  check_refused("sun_speed_rpm = 1128\n", "", {"sun_speed_rpm", "carrier_speed_rpm"});
  check_refused("[15, 36, 17, 38, 19]", "[15, 36, 17]", {"3 values for 5 planets"});
  check_refused("outside_diameter_mm = 663.6", "outside_diameter_mm = 663.6\nrim_thickness_mm = 20",
                {"rim_thickness_mm", "either"});
  check_refused("outside_diameter_mm = 663.6\n", "", {"outside_diameter_mm", "rim_thickness_mm"});
  check_refused("outside_diameter_mm = 663.6", "outside_diameter_mm = 663.6\npins = 24", {"ring.pins", "pinned"});
  check_refused("name = \"held\"", "name = \"a/b\"", {"ring.name", "folder"});
  check_refused("name = \"held\"", "name = \"..\"", {"ring.name", "folder"});
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
  check_refused("kind = \"planetary\"", "kind = \"helical_pair\"", {"not yet available"});
  check_refused("[errors]", "[monte_carlo]\nsamples = 3\n[errors]", {"monte_carlo", "not yet available"});
  check_refused("title = \"Quick\"", "rung = \"closed_form\"", {"not yet available"});
  check_refused("profile_shift = 0.7608", "profile_shift = 0.7608\nlead_crowning_um = 5",
                {"lead_crowning_um", "not yet available"});
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
      // What an absent key means has to be said, and so has the reason of a default (a title needs none).
      if (p.presence != app::Parameter::Presence::required && p.name != "title") BOOST_TEST(!p.note.empty(), p.key());
      if (p.kind == app::Parameter::Kind::real && p.presence == app::Parameter::Presence::required)
        BOOST_TEST(!p.range_text().empty(), p.key());
    }
  }
  BOOST_TEST(app::explain(*app::find_parameter("stage.module_mm")).find("mm") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_scene_reference_is_up_to_date) {
  std::ifstream in(std::string(ANNULUS_SOURCE_DIR) + "/docs/scene.md");
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
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

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
