#include "app/systems/two_k_v/two_k_v_run.h"
#include "app/plan/plan.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/model/gear_system.h"
#include "core/files.h"
#include "core/log.h"
#include "dynamics/systems/two_k_v/two_k_v_figures.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"

namespace annulus {

namespace {

app::TwoKVResult run_reducer(const std::string& text, const std::filesystem::path& out, int threads = 2) {
  log::set_level(log::Level::quiet);
  return app::run_two_k_v(app::parse_scene(text, "reducer.toml"), {.out = out, .threads = threads});
}

/// Both meshes change in time, arc teeth from the contact formulas.
std::string moving_scene() {
  const auto text = test::replaced(test::reducer_scene(), "stiffness = \"constant\"\nmean_N_per_m = 1.4e8",
                                   "stiffness = \"harmonic\"\nmean_N_per_m = 1.4e8\nripple = 0.15");
  return test::replaced(text, "stiffness = \"constant\"\nmean_N_per_m = 7.5e8", "stiffness = \"computed\"");
}

double point_value(const app::StudyPoint& point, const std::string& column) { return point.value(column); }

}  // namespace

BOOST_AUTO_TEST_SUITE(two_k_v_run)

// The published 131 Hz with the assumed inputs, and the estimate that explains it: the whole train as one mass on the
// static torsional stiffness. Rayleigh's quotient with the motion of the undeformed train lies above the frequency of
// the soft mode only by what the other modes take, here below a thousandth.
BOOST_AUTO_TEST_CASE(first_frequency_and_its_estimate) {
  const test::TemporaryFolder folder("reducer");
  const auto result = run_reducer(test::reducer_scene(), folder.path());
  const auto& v = *result.own.vibration;
  BOOST_TEST(std::abs(v.first_frequency() - 131.0) <= 0.05);
  BOOST_TEST(std::abs(v.estimate.train_frequency / v.first_frequency() - 1) <= 1e-3);
  BOOST_TEST(v.estimate.input_frequency > v.estimate.train_frequency);
  // Shares of the energies, and the strongest inputs.
  double stiffnesses = 0, inertias = 0;
  for (const auto& input : v.inputs) {
    if (input.name == "module" || input.name == "pressure_angle" || input.name == "eccentricity") continue;
    (input.sensitivity > 0 ? stiffnesses : inertias) += input.sensitivity;
  }
  BOOST_TEST(std::abs(stiffnesses - 0.5) <= 1e-9);
  BOOST_TEST(std::abs(inertias + 0.5) <= 1e-9);
  BOOST_TEST(v.inputs[0].key == "stage.module_mm");
  BOOST_TEST(v.inputs[1].key == "input.inertia_kg_m2");
  // One DOF: f1 ~ J^s nearly, so that the band follows from the sensitivity to second order.
  const auto& inertia = v.inputs[1];
  BOOST_REQUIRE((inertia.band.low && inertia.band.high));
  BOOST_TEST(std::abs(*inertia.band.low / std::pow(1.05, 1 / inertia.sensitivity) - 1) <= 0.02);
  BOOST_TEST(std::abs(*inertia.band.high / std::pow(0.95, 1 / inertia.sensitivity) - 1) <= 0.02);
  // Constant mesh stiffness moves nothing, and every mesh carries its mean force.
  const auto& m = *result.own.motion;
  BOOST_TEST(m.steady);
  BOOST_TEST(!m.output_moves());
  BOOST_TEST(std::abs(dynamics::largest(m.sun_planet, &dynamics::BranchResult::dynamic_factor).value - 1) <= 1e-5);
  BOOST_TEST(std::abs(std::abs(m.error_mean) * v.torsion.mean() / 58 - 1) <= 1e-6);
  const auto json = nlohmann::json::parse(read_file(folder.path() / "summary.json"));
  BOOST_TEST(json["vibration"]["first_frequency_Hz"].get<double>() == v.first_frequency());
  BOOST_TEST(json["operating_point"]["ratio"] == 103.0);
  const auto report = read_file(folder.path() / "report.html");
  for (const char* id : {"frequencies", "first-frequency", "torsion", "motion", "stiffness", "inputs"})
    BOOST_TEST(report.find("id=\"" + std::string(id) + "\"") != std::string::npos, id);
  for (const char* file : {"modes.csv", "mode_shapes.csv", "mode_shapes_over_crank.csv", "modes_over_crank.csv",
                           "torsional_stiffness.csv", "sensitivity_f1.csv", "time_series.csv", "output_error.csv"})
    BOOST_TEST(std::filesystem::exists(folder.path() / "dynamics" / file), file);
}

BOOST_AUTO_TEST_CASE(runs_agree_whatever_the_threads_and_are_reused) {
  const test::TemporaryFolder folder("reducer_threads");
  // One turn of the crank from equilibrium will do for the comparison.
  const auto text =
      moving_scene() + "mesh_cycles = 34\n[[sweep]]\ninput = \"crank.bearing_N_per_m\"\nvalues = [1e8, 1.5e8, 3e8]\n";
  const auto one = run_reducer(text, folder.path() / "one", 1);
  const auto three = run_reducer(text, folder.path() / "three", 3);
  BOOST_TEST(!one.own.motion->reused);
  BOOST_TEST(one.own.motion->output_moves());
  for (const char* file : {"output_error.csv", "forces.csv", "modes_over_crank.csv", "sweep_1.csv"})
    BOOST_TEST(read_file(folder.path() / "one/dynamics" / file) == read_file(folder.path() / "three/dynamics" / file),
               file);
  const auto again = run_reducer(text, folder.path() / "one", 2);
  BOOST_TEST(again.own.motion->reused);
  BOOST_TEST(again.own.motion->error_peak_to_peak.value == one.own.motion->error_peak_to_peak.value);
  BOOST_TEST(again.own.motion->output_error.rows == one.own.motion->output_error.rows);
  BOOST_TEST(again.own.motion->arc_bearings.size() == one.own.motion->arc_bearings.size());
  // The value of the scene is a point of the sweep; a softer bearing lowers the frequency by its sensitivity.
  const auto& points = three.studies.sweeps.front().variants.front();
  const auto& v = *three.own.vibration;
  BOOST_TEST(point_value(points[1], "frequency_1_Hz") == v.first_frequency(), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(point_value(points[1], "output_error_peak_to_peak_rad") == three.own.motion->error_peak_to_peak.value,
             boost::test_tools::tolerance(1e-9));
  BOOST_TEST(point_value(points[0], "frequency_1_Hz") < v.first_frequency());
  BOOST_TEST(point_value(points[2], "frequency_1_Hz") > v.first_frequency());
}

// The compared case is the run of a scene that computes the mesh.
BOOST_AUTO_TEST_CASE(comparison_is_the_run_with_computed_stiffness) {
  const test::TemporaryFolder folder("reducer_compare");
  const auto scene = test::reducer_scene() + "mesh_cycles = 34\n";
  const auto given = test::replaced(scene, "mean_N_per_m = 7.5e8", "mean_N_per_m = 7.5e8\ncompare = \"computed\"");
  const auto both = run_reducer(given, folder.path() / "both");
  const auto alone =
      run_reducer(test::replaced(scene, "stiffness = \"constant\"\nmean_N_per_m = 7.5e8", "stiffness = \"computed\""),
                  folder.path() / "alone");
  BOOST_REQUIRE(both.computed.has_value());
  BOOST_TEST(!alone.computed.has_value());
  BOOST_TEST(both.computed->vibration->first_frequency() == alone.own.vibration->first_frequency());
  BOOST_TEST(both.computed->motion->error_peak_to_peak.value == alone.own.motion->error_peak_to_peak.value);
  BOOST_TEST(both.own.vibration->first_frequency() < both.computed->vibration->first_frequency());
  BOOST_TEST(std::filesystem::exists(folder.path() / "both/computed/stiffness_arc_pins.csv"));
}

// Play and clearance at the output by virtual work: what the flanks may move times the turn of the output per metre.
BOOST_AUTO_TEST_CASE(lost_motion_of_backlash) {
  auto stage = app::two_k_v_kinematics(app::parse_scene(test::reducer_scene(), "reducer.toml"));
  stage.sun_half_backlash = 10e-6;
  stage.arc_half_backlash = 2e-6;
  const auto lost = annulus::dynamics::lost_motion(stage, 7e4, 1e-6);
  // The sun turns freely by 20 µm / r_bs; an arc mesh open by e lets the output turn by e z_p/(a z_s ratio).
  const double sun = 20e-6 / (5e-3 * std::cos(20 * std::numbers::pi / 180)) / 103,
               arc = 6e-6 * 34 / (0.9e-3 * 10 * 103);
  BOOST_TEST(lost.backlash == sun + arc, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(lost.elastic == 0.06 * 58 / 7e4, boost::test_tools::tolerance(1e-12));
}

// The clearance of the arcs is no part of the model that moves, but of the results beside it.
BOOST_AUTO_TEST_CASE(another_clearance_is_another_result) {
  const test::TemporaryFolder folder("reducer_clearance");
  const auto lost = [&](const std::string& text, const char* out) {
    return run_reducer(text, folder.path() / out).variants().front().figures.value("lost_motion_rad");
  };
  const auto without = test::replaced(test::reducer_scene() + "mesh_cycles = 34\n", "mean_N_per_m = 7.5e8\n",
                                      "mean_N_per_m = 7.5e8\ncompare = \"computed\"\n"),
             with = test::replaced(without, "width_mm = 8\n", "width_mm = 8\nclearance_um = 2\n");
  const double first = lost(without, "same"), second = lost(with, "same");
  BOOST_TEST(second == lost(with, "fresh"), boost::test_tools::tolerance(1e-14));
  BOOST_TEST(second > 1.01 * first);
}

BOOST_AUTO_TEST_CASE(studies_answer_with_named_figures) {
  const test::TemporaryFolder folder("reducer_studies");
  const auto result =
      run_reducer(test::reducer_scene() + "mesh_cycles = 34\n" +
                      "[monte_carlo]\nsamples = 30\nseed = 3\n[[monte_carlo.input]]\ninput = \"input.inertia_kg_m2\"\n"
                      "distribution = \"lognormal\"\nmean = 8.405e-6\ndeviation = 8.405e-7\n"
                      "[sensitivity]\ninputs = [\"crank.bearing_N_per_m\", \"output.torque_Nm\"]\nfactor = 1.1\n",
                  folder.path());
  const auto& samples = result.studies.monte_carlo->variants.front();
  BOOST_TEST(samples.failed == 0);
  const auto* frequency = samples.find("frequency_1_Hz");
  BOOST_REQUIRE(frequency);
  // 10 % of the input's inertia are 4.1 % of the frequency; 30 samples know their deviation to 13 %.
  BOOST_TEST(std::abs(frequency->deviation / (0.0409 * 131) - 1) <= 0.4);
  const auto& row = result.studies.sensitivity->rows.front();
  const double divided = point_value(row.divided.front(), "frequency_1_Hz"),
               multiplied = point_value(row.multiplied.front(), "frequency_1_Hz");
  // The exact derivative against this difference.
  BOOST_TEST(std::abs(std::log(multiplied / divided) / (2 * std::log(1.1)) - 0.2542) <= 1e-3);
  // A linear stage: twice the torque, twice the wind-up, the same frequency.
  const auto& torque = result.studies.sensitivity->rows[1];
  BOOST_TEST(point_value(torque.multiplied.front(), "wind_up_rad") ==
                 1.21 * point_value(torque.divided.front(), "wind_up_rad"),
             boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(plan_and_scenes_without_dynamics) {
  const auto scene = app::parse_scene(moving_scene(), "reducer.toml");
  const auto plan = app::make_plan(scene);
  BOOST_TEST(plan.meshes.size() == 2U);
  BOOST_TEST(plan.meshes[1].fidelity == "line_contact");
  BOOST_TEST(plan.dofs.size() == 8U);
  BOOST_TEST(text_of(app::to_json(app::make_plan(scene))).find("\"ratio\": 103") != std::string::npos);
  const test::TemporaryFolder folder("reducer_solve");
  auto text = test::reducer_scene();
  text.erase(text.find("[dynamics]"));
  const auto result = run_reducer(text, folder.path());
  BOOST_TEST((result.own.vibration == nullptr));
  BOOST_TEST(read_file(folder.path() / "report.html").find("id=\"stiffness\"") != std::string::npos);
}

// The involute pair by finite elements, closed-form model: of the order of ISO 6336's 14 to 20 N/(mm µm).
BOOST_AUTO_TEST_CASE(sun_mesh_from_the_pipeline) {
  const test::TemporaryFolder folder("reducer_pipeline");
  auto text = test::replaced(test::reducer_scene(), "stiffness = \"constant\"\nmean_N_per_m = 1.4e8",
                             "stiffness = \"computed\"");
  text = test::replaced(text, "[planet]", "bore_diameter_mm = 4\n[planet]\nbore_diameter_mm = 14");
  text = test::replaced(text, "title = \"Reducer\"\n", "title = \"Reducer\"\nmodel = \"closed_form\"\n");
  const auto result = run_reducer(text, folder.path());
  const double per_width = result.own.tables.sun.mean_stiffness().value / 10e-3;
  BOOST_TEST(per_width > 8e9);
  BOOST_TEST(per_width < 25e9);
  BOOST_TEST(result.own.motion->output_moves());
  BOOST_TEST(result.own.tables.sun.table.mesh() == "sun_planet");
  const auto again = run_reducer(text, folder.path());
  BOOST_TEST(again.own.tables.sun.reused);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
