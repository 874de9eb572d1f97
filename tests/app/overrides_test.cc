#include "app/scene/overrides.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "app/model/study_cases.h"
#include "app/study/studies.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/shared/space_input.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/units.h"
#include "tests/app/scenes.h"
#include "tests/app/statics_scenes.h"

namespace annulus {

namespace {

app::Scene quick_with(const std::string& more = "") {
  return app::parse_scene(test::quick_scene() + more, "scene.toml");
}

/// Two rings, one of them with pins and a dot in its name.
app::Scene two_rings() {
  auto text = test::quick_scene();
  const auto begin = text.find("[[ring]]"), end = text.find("[errors]");
  auto second = text.substr(begin, end - begin);
  second = test::replaced(second, "\"held\"", "\"pins.24\"");
  second = test::replaced(second, "structure = \"traditional\"",
                          "structure = \"pinned\"\npins = 24\npin_diameter_mm = 15.5");
  return app::parse_scene(text.insert(end, second), "two.toml");
}

template <class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void check_message(const std::string& message, const std::vector<std::string>& words) {
  BOOST_TEST(!message.empty());
  for (const auto& word : words) BOOST_TEST(message.find(word) != std::string::npos, message << " lacks " << word);
}

std::string refusal(const app::Scene& scene, const app::Override& change) {
  return message_of([&] { (void)app::with_overrides(scene, {change}); });
}

}  // namespace

BOOST_AUTO_TEST_SUITE(overrides)

BOOST_AUTO_TEST_CASE(values_are_set_before_the_checks) {
  const auto scene = quick_with();
  const auto changed =
      app::with_overrides(scene, {{"stage.power_kW", 1000},
                                  {"stage.sun_speed_rpm", 900},
                                  {"supports.ring_N_per_m", 2e9},  // not in the file
                                  {"mesh.sun_planet.mean_N_per_m", 1e9},
                                  {"errors.planet_eccentricity_um[2]", 40},
                                  {"errors.planet_pin_position_error_phase_deg[5]", 90},  // list not there
                                  {"sun.teeth", 48}});
  BOOST_TEST(*planetary(changed).stage.power == 1e6);
  BOOST_TEST(*planetary(changed).stage.sun_speed == 900 * units::rpm, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(planetary(changed).supports.ring == 2e9);
  BOOST_TEST(*sun_and_planets(changed).sun_planet.mean == 1e9);
  const std::vector<double> eccentricity = {15, 40, 17, 38, 19};
  for (std::size_t n = 0; n < 5; ++n)
    BOOST_TEST(planetary(changed).errors.planet_eccentricity[n] == eccentricity[n] * units::um,
               boost::test_tools::tolerance(1e-15));
  BOOST_TEST(planetary(changed).errors.planet_pin_position_phase[4] == 90 * units::deg,
             boost::test_tools::tolerance(1e-15));
  BOOST_TEST(planetary(changed).errors.planet_pin_position_phase[0] == 0.0);
  // The scene itself is as it was, and so is one changed by nothing.
  BOOST_TEST(*planetary(scene).stage.power == 2958.8e3);
  const auto same = app::with_overrides(scene, {});
  BOOST_TEST_REQUIRE(same.inputs.size() == scene.inputs.size());
  for (std::size_t i = 0; i < same.inputs.size(); ++i)
    BOOST_TEST((same.inputs[i].value == scene.inputs[i].value), same.inputs[i].key);
}

BOOST_AUTO_TEST_CASE(rings_are_named_or_all_meant) {
  const auto scene = two_rings();
  const auto all = app::with_overrides(scene, {{"ring.mass_kg", 50}});
  BOOST_TEST(*planetary(all).rings[0].mass == 50.0);
  BOOST_TEST(*planetary(all).rings[1].mass == 50.0);
  const auto one = app::with_overrides(scene, {{"ring.pins.24.mass_kg", 50}});
  BOOST_TEST(*planetary(one).rings[0].mass == 31.25);
  BOOST_TEST(*planetary(one).rings[1].mass == 50.0);
  // Only one of them has pins: the other stays without.
  const auto pins = app::with_overrides(scene, {{"ring.pins", 12}});
  BOOST_TEST(!planetary(pins).rings[0].pins.has_value());
  BOOST_TEST(*planetary(pins).rings[1].pins == 12);
  // A factor takes each ring's own value.
  const auto thin = app::with_overrides(scene, {{"ring.outside_diameter_mm", 1.01, true}});
  for (const auto& ring : planetary(thin).rings)
    BOOST_TEST(*ring.outside_diameter == 1.01 * 0.6636, boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(a_factor_multiplies_the_value_of_each_bearing) {
  const auto scene = app::parse_scene(test::statics::helical_stage() + test::statics::in_space(), "scene.toml");
  const auto doubled = app::with_overrides(scene, {{"bearing.axial_N_per_m", 2, true}});
  const auto &before = scene.own<app::SpaceInput>().bearings, &after = doubled.own<app::SpaceInput>().bearings;
  BOOST_TEST_REQUIRE(after.size() == before.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    BOOST_TEST(after[i].axial == 2 * before[i].axial, boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(factors_multiply_each_present_value) {
  const auto scene = two_rings();
  const auto heavier = app::with_overrides(scene, {{"ring.pins.24.mass_kg", 2, true}, {"ring.pins", 0.5, true}});
  BOOST_TEST(*planetary(heavier).rings[1].mass == 62.5);
  BOOST_TEST(*planetary(heavier).rings[1].pins == 12);
  BOOST_TEST(planetary(app::with_overrides(scene, {{"errors.planet_eccentricity_um[3]", 2, true}}))
                     .errors.planet_eccentricity[2] == 34e-6,
             boost::test_tools::tolerance(1e-15));
  check_message(refusal(scene, {"supports.ring_N_per_m", 2, true}), {"supports.ring_N_per_m", "rigid"});
  check_message(refusal(scene, {"sun.tip_diameter_mm", 2, true}), {"sun.tip_diameter_mm", "no value"});
}

BOOST_AUTO_TEST_CASE(wrong_paths_and_values_are_refused) {
  const auto scene = two_rings();
  check_message(refusal(scene, {"supports.planet_N_per", 1e9}), {"did you mean supports.planet_N_per_m?"});
  check_message(refusal(scene, {"ring.pins.24.pinz", 12}), {"did you mean ring.pins.24.pins?"});
  check_message(refusal(scene, {"stage.kind", 1}), {"stage.kind", "not a number"});
  check_message(refusal(scene, {"title", 1}), {"not a number"});
  check_message(refusal(scene, {"monte_carlo.samples", 1}), {"monte_carlo.samples"});
  check_message(refusal(scene, {"ring.splines", 54}), {"no ring of this scene has this key"});
  check_message(refusal(scene, {"ring.pins", 12.5}), {"ring.pins = 12.5", "whole number", "not rounded"});
  check_message(refusal(scene, {"ring.pins", 0}), {"ring.pins = 0", "1 <= value <= 2000"});
  check_message(refusal(scene, {"stage.power_kW", -1}), {"stage.power_kW = -1", "0 < value"});
  check_message(refusal(scene, {"errors.planet_eccentricity_um", 1}), {"is a list", "[1] for planet 1"});
  for (const auto* index : {"[0]", "[6]", "[x]", "[]", "[1.5]"})
    check_message(refusal(scene, {std::string("errors.planet_eccentricity_um") + index, 1}),
                  {"from 1 to 5", "number of the planet"});
  check_message(refusal(scene, {"stage.power_kW[1]", 1}), {"not a list"});
  check_message(refusal(scene, {"stage.carrier_speed_rpm", 100}), {"is given beside stage.sun_speed_rpm"});
}

BOOST_AUTO_TEST_CASE(study_tables_are_checked) {
  const auto refused = [](const std::string& more, const std::vector<std::string>& words) {
    check_message(message_of([&] { (void)quick_with(more); }), words);
  };
  const auto sweep = [](const std::string& keys) { return "[[sweep]]\ninput = \"stage.power_kW\"\n" + keys; };
  BOOST_TEST(quick_with(sweep("from = 1000\nto = 3000\ncount = 3\n")).sweeps.front().points() ==
                 (std::vector<double>{1000, 2000, 3000}),
             boost::test_tools::per_element());
  const auto logarithmic =
      quick_with(sweep("from = 10\nto = 1000\ncount = 3\nscale = \"logarithmic\"\n")).sweeps.front();
  BOOST_TEST(logarithmic.points()[1] == 100.0, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(quick_with(sweep("values = [7, 5]\n")).sweeps.front().points().size() == 2U);
  refused(sweep(""), {"sweep.from: from, to and count, or values are required"});
  refused(sweep("from = 1\nvalues = [2]\n"), {"sweep.values", "either"});
  refused(sweep("values = [2, 2]\n"), {"twice"});
  refused(sweep("from = -1\nto = 1\ncount = 5\nscale = \"logarithmic\"\n"), {"sweep.from = -1", "0 < value"});
  refused(sweep("from = 1\nto = 2\ncount = 1\n"), {"sweep.count = 1"});
  refused("[[sweep]]\ninput = \"stage.pwer_kW\"\nvalues = [1]\n",
          {"scene.toml:54:1: sweep.input = stage.pwer_kW: there is no", "did you mean stage.power_kW?"});
  refused("[monte_carlo]\nseed = 3\n", {"monte_carlo.samples", "missing"});
  const auto random = [](const std::string& keys) {
    return "[monte_carlo]\nsamples = 5\n[[monte_carlo.input]]\n" + keys;
  };
  refused(random("input = \"planet.mass_kg\"\ndistribution = \"normal\"\nmean = 8\n"),
          {"monte_carlo.input.deviation: is required by distribution = \"normal\""});
  refused(random("input = \"planet.mass_kg\"\ndistribution = \"uniform\"\nlow = 8\n"),
          {"monte_carlo.input.high: is required by distribution = \"uniform\""});
  refused(random("input = \"planet.mass\"\ndistribution = \"uniform\"\nlow = 8\nhigh = 9\n"), {"planet.mass_kg?"});
  refused("[sensitivity]\ninputs = [\"planet.mas_kg\"]\n", {"planet.mass_kg?"});
  refused("[sensitivity]\nfactor = 1\n", {"sensitivity.factor = 1"});
  refused("[sensitivity]\ninputs = [3]\n", {"a list of texts"});
  // Studies are of the dynamics.
  const auto text = test::quick_scene();
  check_message(message_of([&] {
                  (void)app::parse_scene(text.substr(0, text.find("[dynamics]")) + "[monte_carlo]\nsamples = 5\n", "s");
                }),
                {"[dynamics]"});
}

BOOST_AUTO_TEST_CASE(every_value_of_a_study_is_checked_first) {
  const auto refused = [](const std::string& more, const std::vector<std::string>& words) {
    check_message(message_of([&] { app::check_studies(quick_with(more)); }), words);
  };
  refused("[[sweep]]\ninput = \"stage.power_kW\"\nvalues = [1, 2, -1]\n",
          {"sweep.values", "stage.power_kW = -1", "0 < value"});
  // A geometry that cannot exist is found before anything is solved.
  refused("[[sweep]]\ninput = \"stage.centre_distance_mm\"\nvalues = [201, 250]\n", {"value 2 of 2"});
  refused("[sensitivity]\ninputs = [\"sun.teeth\"]\n", {"[sensitivity] sun.teeth / 2"});
  refused("[sensitivity]\ninputs = [\"stage.planets\"]\n", {"stage.planets", "whole number"});
  const auto random = [](const std::string& keys) {
    return "[monte_carlo]\nsamples = 50\n[[monte_carlo.input]]\n" + keys;
  };
  refused(random("input = \"dynamics.mesh_damping_ratio\"\ndistribution = \"normal\"\nmean = 0.07\ndeviation = 0.07\n"),
          {"dynamics.mesh_damping_ratio", "sample", "draws -", "0 <= value <= 2", "truncate"});
  BOOST_CHECK_NO_THROW(app::check_studies(quick_with(
      random("input = \"dynamics.mesh_damping_ratio\"\ndistribution = \"normal\"\nmean = 0.07\ndeviation = 0.07\n"
             "low = 0\n"))));
  refused(random("input = \"sun.teeth\"\ndistribution = \"uniform\"\nlow = 40\nhigh = 50\n"), {"whole number"});
  // No errors and no inputs: nothing is uncertain.
  check_message(
      message_of([&] {
        app::check_studies(app::parse_scene(
            test::replaced(test::quick_scene(), test::quick_errors(), "") + "[monte_carlo]\nsamples = 5\n", "s"));
      }),
      {"nothing is uncertain"});
  // An input of a computed mesh changes its stiffness table.
  auto text =
      test::replaced(test::quick_scene(),
                     "[mesh.ring_planet]\nstiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294\n", "");
  text = test::replaced(text, "teeth = 55\n", "teeth = 55\nbore_diameter_mm = 172\n");
  const auto computed = [&](const std::string& keys) {
    return message_of([&] { app::check_studies(app::parse_scene(text + random(keys), "s")); });
  };
  check_message(computed("input = \"ring.outside_diameter_mm\"\ndistribution = \"uniform\"\nlow = 660\nhigh = 666\n"),
                {"ring.outside_diameter_mm", "changes the stiffness table", "'held'", "[[sweep]]"});
  // Power moves the load within the table, which is interpolated.
  BOOST_TEST(computed("input = \"stage.power_kW\"\ndistribution = \"uniform\"\nlow = 2900\nhigh = 3000\n").empty());
}

BOOST_AUTO_TEST_CASE(unknown_phases_are_those_of_errors_that_exist) {
  const auto names = [](const std::string& more) {
    std::vector<std::string> list;
    const auto sampling = app::sampling_of(quick_with("[monte_carlo]\nsamples = 5\n" + more));
    BOOST_TEST_REQUIRE(sampling.has_value());
    for (const auto& v : sampling->variables) list.push_back(v.input);
    return list;
  };
  const std::vector<std::string> planets = {
      "errors.planet_eccentricity_phase_deg[1]", "errors.planet_eccentricity_phase_deg[2]",
      "errors.planet_eccentricity_phase_deg[3]", "errors.planet_eccentricity_phase_deg[4]",
      "errors.planet_eccentricity_phase_deg[5]"};
  BOOST_TEST(names("") == planets, boost::test_tools::per_element());
  BOOST_TEST(names("phases = \"prescribed\"\n").empty());
  // A drawn error has a phase too, and one with a distribution of its own is not drawn twice.
  const auto more = names(
      "[[monte_carlo.input]]\ninput = \"errors.sun_eccentricity_um\"\ndistribution = \"uniform\"\nlow = 0\nhigh = 9\n"
      "[[monte_carlo.input]]\ninput = \"errors.planet_eccentricity_phase_deg[*]\"\ndistribution = \"uniform\"\nlow = "
      "0\nhigh = 90\n");
  BOOST_TEST(more.size() == 7U);
  BOOST_TEST(more[0] == "errors.sun_eccentricity_phase_deg");
  BOOST_TEST(more[1] == "errors.sun_eccentricity_um");
  BOOST_TEST(more[6] == planets[4]);
}

// Without [monte_carlo], phases that the scene does not state, or states as assumed, are drawn a few times.
BOOST_AUTO_TEST_CASE(unstated_phases_are_drawn_without_being_asked) {
  const std::string key = "planet_eccentricity_phase_deg";
  const auto unstated = test::replaced(test::quick_scene(), key + " = [0, 0, 0, 0, 0]\n", "");
  const auto sampling_in = [](const std::string& text) {
    return app::sampling_of(app::parse_scene(text, "scene.toml"));
  };
  const auto sampling = sampling_in(unstated);
  BOOST_TEST_REQUIRE(sampling.has_value());
  BOOST_TEST((sampling->by_default && sampling->samples == 20 && sampling->variables.size() == 5U));
  BOOST_TEST(!sampling_in(unstated + "[monte_carlo]\nsamples = 0\n"));
  BOOST_TEST(!sampling_in(test::quick_scene()));
  BOOST_TEST(sampling_in(test::quick_scene() + "[assumed]\nerrors." + key + " = \"not printed\"\n").has_value());
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
