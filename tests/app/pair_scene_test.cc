#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "app/model/gear_system.h"
#include "app/model/study_cases.h"
#include "app/systems/helical_pair/pair_errors.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/pair_model.h"
#include "app/systems/helical_pair/pair_stiffness.h"
#include "core/units.h"
#include "fem/closed_form/helical_table.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

app::Scene parsed_pair(const std::string& text) { return app::parse_scene(text, "pair.toml"); }

const app::Input& input_of(const app::Scene& scene, const std::string& key) {
  for (const auto& input : scene.inputs) {
    if (input.key == key) return input;
  }
  throw std::logic_error("no input " + key);
}

double mean_secant_of(const StiffnessTable& table, double load) {
  return curves_at_load(table, load).stiffness_secant.mean();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(pair_scene)

BOOST_AUTO_TEST_CASE(absent_inertias_and_centre_distance_are_derived) {
  const auto scene = parsed_pair(test::quick_pair());
  // A solid disc of the reference radius m z/(2 cos beta); standard centre distance without shifts.
  const double r = 0.015 * 21 / (2 * std::cos(14 * units::deg));
  const auto& inertia = input_of(scene, "pinion.inertia_kg_m2");
  BOOST_CHECK(inertia.origin == app::Origin::derived);
  BOOST_TEST(std::get<double>(inertia.value) == 0.5 * 205 * r * r, boost::test_tools::tolerance(1e-12));
  const auto& distance = input_of(scene, "stage.centre_distance_mm");
  BOOST_CHECK(distance.origin == app::Origin::derived);
  BOOST_TEST(std::get<double>(distance.value) == 15 * 58 / (2 * std::cos(14 * units::deg)),
             boost::test_tools::tolerance(1e-9));
  // Given ones stay.
  const auto given =
      parsed_pair(test::replaced(test::quick_pair(), "mass_kg = 289", "mass_kg = 289\ninertia_kg_m2 = 9"));
  BOOST_CHECK(input_of(given, "wheel.inertia_kg_m2").origin == app::Origin::scene);
  BOOST_TEST(*app::pair_inertia(given, helical_pair(given).wheel) == 9.0);
}

BOOST_AUTO_TEST_CASE(profile_shifts_set_the_centre_distance_without_backlash) {
  auto text =
      test::replaced(test::quick_pair(), "teeth = 21\nprofile_shift = 0\n", "teeth = 21\nprofile_shift = 0.3\n");
  const auto geometry = app::make_pair_geometry(parsed_pair(text));
  // Rounding of a metre.
  BOOST_TEST(std::abs(geometry.gears.normal_backlash()) < 1e-14);
  BOOST_TEST(geometry.gears.centre_distance() >
             app::make_pair_geometry(parsed_pair(test::quick_pair())).gears.centre_distance());
}

BOOST_AUTO_TEST_CASE(the_lumped_pair_has_the_statics_of_the_gears) {
  const auto scene = parsed_pair(test::quick_pair());
  const auto geometry = app::make_pair_geometry(scene);
  const auto pair = app::make_pair(scene, geometry, app::pair_excitation(scene, geometry, {}), 13.1e-6);
  // Textbook statics at the reference circle: F_t = T/r, thrust F_t tan beta, normal force F_t/(cos alpha_n cos beta).
  const double r = 0.015 * 21 / (2 * std::cos(14 * units::deg)), tangential = 20e3 / r;
  const double normal = tangential / (std::cos(20 * units::deg) * std::cos(14 * units::deg));
  BOOST_TEST(pair.static_force() == normal, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(pair.static_force() * std::sin(pair.base_helix_angle) == tangential * std::tan(14 * units::deg),
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(pair.mesh_frequency() == 525.0, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(pair.mesh_error.amount == 13.1e-6);
  BOOST_TEST(*pair.half_backlash == 150e-6, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(dynamics::mean_stiffness(pair.mesh) == app::iso_pair_stiffness(scene, geometry));
}

BOOST_AUTO_TEST_CASE(every_reading_of_95_percent_has_its_exact_value) {
  const auto scene = parsed_pair(test::quick_pair());
  const auto errors = app::pair_errors(scene);
  const auto exact = [&](const char* name, double um) {
    // The values are known to three decimals of a micrometre.
    BOOST_TEST(std::abs(errors.law->at(name).exact / units::um - um) < 1e-3, name);
  };
  exact("pinion_error", 9.252);
  exact("pinion_error_magnitude", 11.025);
  exact("pinion_x1", 12.959);
  exact("pinion_envelope", 13.254);
  exact("sum", 13.085);
  const auto& taken = errors.law->at("pinion_envelope");
  BOOST_TEST(errors.amplitude == taken.sample.value);
  BOOST_TEST(taken.sample.low < taken.exact);
  BOOST_TEST(taken.sample.high > taken.exact);
}

BOOST_AUTO_TEST_CASE(reading_amount_and_divisor_choose_the_amplitude) {
  const auto with = [](const std::string& lines) {
    return app::pair_errors(
        parsed_pair(test::replaced(test::quick_pair(), "[manufacturing_error]\n", "[manufacturing_error]\n" + lines)));
  };
  BOOST_TEST(std::abs(with("reading = \"sum\"\namount = \"exact\"\n").amplitude / units::um - 13.085) < 1e-3);
  // The scales go with 1/divisor.
  const auto printed = with("amount = \"exact\"\n"), exact = with("amount = \"exact\"\ndivisor = \"exact\"\n");
  BOOST_TEST(exact.amplitude / printed.amplitude == 6.8 / (2 * std::sqrt(-2 * std::log(0.003))),
             boost::test_tools::tolerance(1e-9));
  BOOST_TEST(with("reading = \"none\"\n").amplitude == 0.0);
  const auto given = test::replaced(test::quick_pair(), "[manufacturing_error]\n",
                                    "[errors]\nmesh_error_um = 7\n[manufacturing_error]\nreading = \"none\"\n");
  BOOST_TEST(app::pair_errors(parsed_pair(given)).amplitude == 7e-6, boost::test_tools::tolerance(1e-12));
  // Another seed is another law, also where the last one is remembered.
  BOOST_TEST(with("seed = 2\n").amplitude != with("").amplitude);
}

BOOST_AUTO_TEST_CASE(normal_and_transverse_tables_hold_the_same_work) {
  const auto scene = parsed_pair(test::quick_pair());
  const auto geometry = app::make_pair_geometry(scene);
  const auto transverse = app::closed_form_pair_table(scene, geometry, geometry.transverse_force);
  const auto normal = fem::along_normal(transverse, geometry.base_helix_angle);
  for (int load = 0; load < static_cast<int>(normal.loads().size()); ++load) {
    const auto i = static_cast<std::size_t>(load);
    const auto &n = normal.at(0, 5, load), &t = transverse.at(0, 5, load);
    BOOST_TEST(normal.loads()[i] * n.lte == transverse.loads()[i] * t.lte, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(normal.loads()[i] / n.lte == n.stiffness_secant, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(n.stiffness_tangent == geometry.to_normal() * t.stiffness_tangent, boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(staggered_slices_keep_the_mean_and_smooth_the_ripple) {
  const auto at_width = [](const std::string& width) {
    return parsed_pair(test::replaced(test::quick_pair(), "face_width_mm = 150", "face_width_mm = " + width));
  };
  const auto range = [](const StiffnessTable& table) {
    double low = 1e99, high = 0;
    for (int i = 0; i < table.phases(); ++i) {
      low = std::min(low, table.at(0, i, 2).stiffness_secant);
      high = std::max(high, table.at(0, i, 2).stiffness_secant);
    }
    return (high - low) / low;
  };
  // Over a whole overlap ratio every phase stands somewhere in the mesh: nothing is left of the ripple but what 64
  // slices miss of a curve with jumps in its slope.
  const double whole = std::numbers::pi * 15 / std::sin(14 * units::deg);
  const auto even = at_width(app::to_text(whole, 15)), narrow = at_width("150");
  const auto even_geometry = app::make_pair_geometry(even), narrow_geometry = app::make_pair_geometry(narrow);
  BOOST_TEST(even_geometry.gears.overlap_ratio() == 1.0, boost::test_tools::tolerance(1e-12));
  const double per_width = narrow_geometry.transverse_force / 0.15;
  const auto even_table = app::closed_form_pair_table(even, even_geometry, per_width * whole / 1e3);
  const auto narrow_table = app::closed_form_pair_table(narrow, narrow_geometry, narrow_geometry.transverse_force);
  BOOST_TEST(range(even_table) < 1e-3);
  BOOST_TEST(range(narrow_table) > 0.05);
  // Equal load per width: the mean stiffness goes with the width alone. Rounding of sums over 64 x 64 values and the
  // interpolation between phases.
  BOOST_TEST(mean_secant_of(even_table, per_width * whole / 1e3) / whole ==
                 mean_secant_of(narrow_table, narrow_geometry.transverse_force) / 150,
             boost::test_tools::tolerance(1e-3));
}

BOOST_AUTO_TEST_CASE(closed_form_and_iso_formula_agree) {
  const auto scene = parsed_pair(test::quick_pair());
  const auto stiffnesses = [&](const app::Scene& of) {
    const auto own = app::make_pair_geometry(of);
    const auto mesh = app::pair_stiffness(of, own, app::pair_mesh_model(of, own), {});
    return app::mean_stiffnesses(of, own, app::PairMesh(mesh));
  };
  const auto list = stiffnesses(scene);
  BOOST_TEST_REQUIRE(list.size() == 3U);
  BOOST_TEST(list[0].taken);
  // ISO 6336-1 gives its mean mesh stiffness as an average over gears of standard proportions; against measured and
  // computed ones it is known to some 10 %.
  BOOST_TEST(std::abs(list[1].value / list[0].value - 1) < 0.1);
  BOOST_TEST(std::isnan(list[2].value));
  const auto modified = parsed_pair(
      test::replaced(test::quick_pair(), "teeth = 21\n", "teeth = 21\ntip_relief_um = 20\ntip_relief_length_mm = 1\n"));
  const auto without = stiffnesses(modified);
  BOOST_TEST(std::isnan(without[1].value));
  BOOST_TEST(without[1].note.find("modifications") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(phases_of_the_errors_are_what_is_random) {
  const auto sampling =
      app::sampling_of(parsed_pair(test::quick_pair() + "[errors]\nwheel_error_um = 5\n[monte_carlo]\nsamples = 3\n"));
  const auto& variables = sampling->variables;
  BOOST_TEST_REQUIRE(variables.size() == 2U);
  BOOST_TEST(variables[0].input == "errors.mesh_error_phase_deg");
  BOOST_TEST(variables[1].input == "errors.wheel_error_phase_deg");
}

BOOST_AUTO_TEST_CASE(default_sensitivity_takes_bearings_damping_and_backlash) {
  const auto inputs = app::sensitivity_inputs(parsed_pair(test::quick_pair() + "[sensitivity]\nfactor = 2\n"));
  const std::vector<std::string> expected = {"pinion.bearing_transverse_N_per_m", "pinion.bearing_axial_N_per_m",
                                             "wheel.bearing_transverse_N_per_m",  "wheel.bearing_axial_N_per_m",
                                             "dynamics.half_backlash_um",         "dynamics.mesh_damping_ratio",
                                             "dynamics.support_damping_ratio"};
  BOOST_TEST(inputs == expected, boost::test_tools::per_element());
}

struct BadPair {
  const char *what, *by;       ///< a line of the scene and what stands there instead
  const char *place, *remedy;  ///< parts of the message
};

BOOST_AUTO_TEST_CASE(bad_input_is_refused_with_place_and_remedy) {
  const BadPair cases[] = {
      // Out of range, of the wrong type, missing or unknown.
      {"pinion_speed_rpm = 1500", "pinion_speed_rpm = 0", "pair.toml:9:1: stage.pinion_speed_rpm = 0",
       "0 < value <= 1e6 r/min"},
      {"pinion_speed_rpm = 1500", "", "stage.pinion_speed_rpm: is missing", "Speed of the pinion"},
      {"pinion_torque_Nm = 20000", "pinion_torque_Nm = \"much\"", "pair.toml:8:1: stage.pinion_torque_Nm",
       "must be a number"},
      {"pinion_torque_Nm = 20000", "pinion_torque_kNm = 20", "pair.toml:8:1: stage.pinion_torque_kNm",
       "did you mean stage.pinion_torque_Nm?"},
      {"teeth = 37", "teeth = 37.5", "wheel.teeth = 37.5", "a whole number"},
      {"mass_kg = 205", "mass_kg = -1", "pinion.mass_kg = -1", "1e-9 <= value"},
      {"mass_kg = 205\n", "", "pinion.mass_kg: is required by [dynamics]", ""},
      {"module_mm = 15", "module_mm = 15\nplanets = 3", "stage.planets = 3", "belongs to planetary"},
      {"[wheel]", "[planet]", "[planet]: has no meaning for a stage of kind \"helical_pair\"",
       "it belongs to planetary"},
      {"bearing_axial_N_per_m = 1e9\n[wheel]", "bearing_axial_N_per_m = -1\n[wheel]",
       "pinion.bearing_axial_N_per_m = -1", "or inf"},
      // Between the keys of the mesh.
      {"stiffness = \"iso_6336\"", "stiffness = \"iso6336\"", "mesh.pinion_wheel.stiffness = \"iso6336\"",
       "did you mean \"iso_6336\"?"},
      {"stiffness = \"iso_6336\"", "stiffness = \"harmonic\"", "mesh.pinion_wheel.mean_N_per_m: is required by",
       "harmonic"},
      {"ripple = 0.05", "ripple = 1.2", "mesh.pinion_wheel.ripple = 1.2", "must stay below 1"},
      {"ripple = 0.05", "mean_N_per_m = 1e9", "mesh.pinion_wheel.mean_N_per_m = 1e9", "has a meaning only with"},
      {"ripple = 0.05", "duty = 0.5", "mesh.pinion_wheel.duty", "rectangular"},
      {"stiffness = \"iso_6336\"\nripple = 0.05", "stiffness = \"computed\"\nsingle_stiffness_GPa = 14",
       "mesh.pinion_wheel.single_stiffness_GPa = 14", "iso_6336"},
      {"bore_diameter_mm = 260", "bore_diameter_mm = 570", "wheel.bore_diameter_mm = 570",
       "must be smaller than the root diameter"},
      // Of the errors.
      {"wheel_tooth_to_tooth_um = 12.927", "wheel_tooth_to_tooth_um = 60",
       "manufacturing_error.wheel_tooth_to_tooth_um = 60", "value <= 48.927"},
      {"pinion_total_um = 48.927\npinion_tooth_to_tooth_um = 12.927",
       "pinion_total_um = 0\npinion_tooth_to_tooth_um = 0", "manufacturing_error.pinion_total_um = 0",
       "must be above 0"},
      {"[manufacturing_error]", "[manufacturing_error]\nreading = \"pinion_envelop\"",
       "manufacturing_error.reading = \"pinion_envelop\"", "did you mean \"pinion_envelope\"?"},
      {"[manufacturing_error]", "[errors]\nmesh_error_um = 5\n[manufacturing_error]", "errors.mesh_error_um = 5",
       "reading = \"none\""},
      {"[manufacturing_error]", "[manufacturing_error]\nsamples = 100\nprobability = 0.999",
       "manufacturing_error.samples = 100", "too few"},
      {"[manufacturing_error]", "[manufacturing_error]\nsamples = 10", "manufacturing_error.samples = 10",
       "100 <= value"},
      {"[manufacturing_error]", "[manufacturing_error]\ndivisor = \"rounded\"", "manufacturing_error.divisor",
       "printed"},
      {"[manufacturing_error]", "[errors]\npinion_wheel_misalignment_um = 5\n[manufacturing_error]",
       "errors.pinion_wheel_misalignment_um = 5", "computed"},
      {"[manufacturing_error]", "[errors]\nsun_eccentricity_um = 5\n[manufacturing_error]",
       "errors.sun_eccentricity_um", "belongs to planetary"},
      // Of what is asked.
      {"[dynamics]", "[transmission_error]\npinion_torques_Nm = []\n[dynamics]", "transmission_error.pinion_torques_Nm",
       "at least one torque"},
      {"[dynamics]", "[transmission_error]\npinion_torques_Nm = [1, -2]\n[dynamics]",
       "transmission_error.pinion_torques_Nm", "0 < each value"},
      {"[dynamics]", "[transmission_error]\npinion_torques_Nm = [5, 5]\n[dynamics]",
       "transmission_error.pinion_torques_Nm", "the same value twice"},
      {"[dynamics]", "[dynamics]\nintegrator = \"runge_kutta_4\"", "dynamics.steps_per_cycle", "runge_kutta_4"},
      {"[dynamics]", "[dynamics]\nrim_coupling = \"none\"", "dynamics.rim_coupling", "belongs to planetary"},
      {"[dynamics]", "[[sweep]]\ninput = \"stage.sun_speed_rpm\"\nvalues = [1]\n[dynamics]",
       "sweep.input = stage.sun_speed_rpm",
       "of a stage of kind \"helical_pair\"; did you mean stage.pinion_speed_rpm?"},
  };
  for (const auto& bad : cases) {
    const auto text = test::replaced(test::quick_pair(), bad.what, bad.by);
    try {
      (void)parsed_pair(text);
      BOOST_ERROR(std::string("taken: ") + bad.by);
    } catch (const InputError& error) {
      const std::string message = error.what();
      BOOST_TEST(message.find(bad.place) != std::string::npos, "no '" << bad.place << "' in " << message);
      BOOST_TEST(message.find(bad.remedy) != std::string::npos, "no '" << bad.remedy << "' in " << message);
    }
  }
}

BOOST_AUTO_TEST_CASE(what_needs_several_changes_is_refused_too) {
  const auto refused = [](const std::string& text, const std::string& message) {
    try {
      (void)parsed_pair(text);
      BOOST_ERROR("taken: " + message);
    } catch (const InputError& error) {
      BOOST_TEST(std::string(error.what()).find(message) != std::string::npos, error.what());
    }
  };
  const auto computed =
      test::replaced(test::quick_pair(), "stiffness = \"iso_6336\"\nripple = 0.05", "stiffness = \"computed\"");
  refused(test::replaced(computed, "bore_diameter_mm = 150\n", ""),
          "pinion.bore_diameter_mm: is required by mesh.pinion_wheel.stiffness = \"computed\"");
  refused(test::replaced(computed, "pinion_torque_Nm = 20000", "pinion_torque_Nm = -5"),
          "must be above 0 with a tabulated stiffness");
  refused(test::replaced(computed, "title", "model = \"plane\"\ntitle"),
          "model = plane: cannot represent the mesh: helical teeth");
  refused(test::replaced(computed, "title", "model = \"closed_form\"\ntitle"),
          "stiffness = \"closed_form\" in [mesh.pinion_wheel]");
  refused(test::replaced(computed, "title", "model = \"resolved\"\ntitle"), "cannot represent helical gears");
  const auto closed =
      test::replaced(test::quick_pair(), "stiffness = \"iso_6336\"\nripple = 0.05", "stiffness = \"closed_form\"");
  refused(test::replaced(closed, "teeth = 21\n", "teeth = 21\nlead_crowning_um = 5\n"),
          "modifications have no closed form");
  auto still =
      test::replaced(test::quick_pair(), "[manufacturing_error]\n", "[manufacturing_error]\nreading = \"none\"\n");
  refused(test::replaced(still, "pinion_torque_Nm = 20000", "pinion_torque_Nm = 0"), "nothing excites the pair");
  // Gears that cannot exist are told where they are made.
  const auto pointed =
      parsed_pair(test::replaced(test::quick_pair(), "teeth = 21\nprofile_shift = 0", "teeth = 8\nprofile_shift = 0"));
  BOOST_CHECK_THROW(app::check_stage(pointed), GeometryError);
}

BOOST_AUTO_TEST_CASE(teeth_that_do_not_fit_are_those_of_pinion_and_wheel) {
  const auto undercut = parsed_pair(
      test::replaced(test::quick_pair(), "teeth = 21\nprofile_shift = 0", "teeth = 21\nprofile_shift = -1"));
  BOOST_CHECK_EXCEPTION(app::check_stage(undercut), GeometryError, [](const GeometryError& error) {
    const std::string text = error.what();
    BOOST_TEST(text.find("the tip of the wheel") != std::string::npos, text);
    BOOST_TEST(text.find("the start of the pinion's involute") != std::string::npos, text);
    return text.find("planet") == std::string::npos && text.find("sun") == std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(a_drawn_error_has_a_phase_that_is_drawn_as_well) {
  const auto drawn = parsed_pair(test::quick_pair());
  const auto& input = input_of(drawn, "errors.mesh_error_um");
  BOOST_CHECK(input.origin == app::Origin::derived);
  // A phase that nobody states is drawn, as that of any error.
  const auto phases = app::unstated_phases(drawn);
  BOOST_TEST((std::find(phases.begin(), phases.end(), "errors.mesh_error_phase_deg") != phases.end()));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
