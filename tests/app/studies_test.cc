#include "app/study/studies.h"
#include "app/model/gear_system.h"
#include "app/plan/plan.h"
#include "app/systems/planetary/planetary_run.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/files.h"
#include "core/log.h"
#include "core/units.h"
#include "tests/app/background_run.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

/// Installation errors alone: they stand still on the carrier, so the windows are short.
std::string short_scene() {
  auto text = test::replaced(test::quick_scene(), "planet_eccentricity_um", "planet_pin_position_error_um");
  return test::replaced(text, "mesh_cycles = 110\n", "mesh_cycles = 20\n");
}

/// Two rings that differ in mass.
std::string two_masses(std::string text) {
  const auto begin = text.find("[[ring]]"), end = text.find("[errors]");
  auto second = test::replaced(text.substr(begin, end - begin), "\"held\"", "\"heavy\"");
  second = test::replaced(second, "mass_kg = 31.25", "mass_kg = 60");
  return test::replaced(text.insert(end, second), "planet_N_per_m = 1e9", "planet_N_per_m = 1e9\nring_N_per_m = 1e9");
}

app::RunResult run_text(const std::string& text, const std::filesystem::path& out, int threads = 2) {
  log::set_level(log::Level::quiet);
  return app::run(app::parse_scene(text, "scene.toml"), {.out = out, .threads = threads});
}

std::vector<double> column(const Csv& csv, const std::string& name) {
  const auto index = csv.column(name);
  std::vector<double> values;
  for (const auto& row : csv.rows) values.push_back(row[index]);
  return values;
}

const std::string ordering_figure = "sun_planet_load_sharing_averaged";

double averaged(const app::StudyPoint& point) { return point.value(ordering_figure); }

constexpr const char* few_samples = "[monte_carlo]\nsamples = 45\nseed = 5\n";

}  // namespace

BOOST_AUTO_TEST_SUITE(studies)

BOOST_AUTO_TEST_CASE(load_classes_are_the_runs_they_stand_for) {
  const test::TemporaryFolder folder("load_spectrum");
  const auto text = two_masses(short_scene());
  const std::string classes =
      "[load_spectrum]\ninputs = [\"stage.power_kW\", \"stage.sun_speed_rpm\"]\n"
      "[[load_spectrum.class]]\nname = \"rated\"\nduration_h = 3000\nvalues = [2958.8, 1128]\n"
      "[[load_spectrum.class]]\nname = \"half speed\"\nduration_h = 1000\nvalues = [739.7, 564]\n";
  const auto result = run_text(text + classes, folder.path() / "all");
  BOOST_TEST_REQUIRE(result.studies.load_spectrum.has_value());
  const auto& found = *result.studies.load_spectrum;
  auto slow = test::replaced(text, "sun_speed_rpm = 1128", "sun_speed_rpm = 564");
  slow = test::replaced(slow, "power_kW = 2958.8", "power_kW = 739.7");
  const auto alone = run_text(slow, folder.path() / "alone");
  for (std::size_t ring = 0; ring < 2; ++ring) {
    const double nominal = result.rings[ring].response->figures.sun_planet.load_sharing.averaged.value,
                 other = alone.rings[ring].response->figures.sun_planet.load_sharing.averaged.value;
    BOOST_TEST(averaged(found.variants[ring][0]) == nominal);
    BOOST_TEST(averaged(found.variants[ring][1]) == other);
    const auto all = found.overall(ring, ordering_figure);
    BOOST_TEST(all.largest == std::max(nominal, other));
    BOOST_TEST(all.of_class == (nominal > other ? 0U : 1U));
    BOOST_TEST(all.mean == (3 * nominal + other) / 4, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(nominal != other);
  }
  const auto csv = Csv::read(folder.path() / "all/heavy/dynamics/load_spectrum.csv");
  BOOST_TEST(column(csv, "duration_h") == (std::vector<double>{3000, 1000}), boost::test_tools::per_element());
  const auto summary = nlohmann::json::parse(read_file(folder.path() / "all/summary.json"));
  const auto& json = summary.at("rings").at("held").at("load_spectrum");
  BOOST_TEST(json.at("classes").at(1).at("name") == "half speed");
  BOOST_TEST(json.at("over_all_classes").at(ordering_figure).contains("mean_over_time"));
  BOOST_TEST(read_file(folder.path() / "all/report.html").find("mean over the time") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(load_classes_that_do_not_fit_are_refused) {
  const auto refused = [&](const std::string& classes, const std::string& why) {
    try {
      (void)app::parse_scene(short_scene() + "[load_spectrum]\ninputs = [\"stage.sun_speed_rpm\"]\n" + classes,
                             "scene.toml");
      BOOST_TEST(false, why);
    } catch (const app::SceneError& error) {
      BOOST_TEST(std::string(error.what()).find(why) != std::string::npos, error.what());
    }
  };
  const std::string one = "[[load_spectrum.class]]\nname = \"a\"\nduration_h = 1\nvalues = [100]\n";
  refused("", "needs a [[load_spectrum.class]]");
  refused(test::replaced(one, "[100]", "[100, 200]"), "has 2 values for 1 inputs");
  refused(test::replaced(one, "[100]", "[-1e13]"), "must be in range");
  refused(one + one, "is the name of another class");
  refused(test::replaced(one, "duration_h = 1", "duration_h = 0"), "duration_h");
}

// At the speed and torque of the stage a course is the steady motion; at twice the torque prescribed stiffnesses bear
// twice the forces.
BOOST_AUTO_TEST_CASE(courses_of_speed_and_torque) {
  const test::TemporaryFolder folder("transients");
  const std::string courses =
      "[[transient]]\nname = \"as it is\"\ntime_s = [0, 0.02]\nspeed_factor = [1, 1]\n"
      "[[transient]]\nname = \"overload\"\ntime_s = [0, 0.02, 0.03, 0.06]\ntorque_factor = [1, 1, 2, 2]\n"
      "[[transient]]\nname = \"run-up\"\ntime_s = [0, 0.15]\nspeed_factor = [0.3, 1.2]\ninertia_turned_by = \"load\"\n"
      "[[transient]]\nname = \"start, stop, back\"\ntime_s = [0, 0.01, 0.06, 0.11, 0.3, 0.35]\n"
      "speed_factor = [0, 0, 1, 0, 0, -0.6]\n";
  const auto result = run_text(short_scene() + courses, folder.path() / "out");
  const auto& found = result.studies.transients;
  BOOST_TEST_REQUIRE(found.size() == 4U);
  for (const auto& course : found) BOOST_TEST(course.variants[0].failure.empty(), course.variants[0].failure);
  const auto series = Csv::read(folder.path() / "out/held/dynamics/time_series.csv");
  const auto& still = found[0].variants[0].response;
  BOOST_TEST(still.settled.value_or(true));
  const auto cycles = still.time.size();
  const auto times = column(series, "time_s"), forces = column(series, "sun_planet1_force_N");
  double most = 0;
  for (std::size_t i = 0; i < times.size() && times[i] < 0.02; ++i) most = std::max(most, forces[i]);
  BOOST_TEST(still.largest.row(0).maxCoeff() == most, boost::test_tools::tolerance(5e-3));
  const auto force = found[0].variants[0].figures.figure(dynamics::course_force_key);
  BOOST_TEST(force.error < 0.05 * force.value);
  BOOST_TEST(force.error > 0);
  const auto& overload = found[1].variants[0].response;
  const auto last = overload.time.size() - 1;
  BOOST_TEST(overload.torque[last] == 2.0);
  // The mean of all planets: each has its share.
  const double before = overload.mean.col(cycles / 2).head(overload.gears / 2).mean(),
               after = overload.mean.col(last).head(overload.gears / 2).mean();
  BOOST_TEST(after == 2 * before, boost::test_tools::tolerance(2e-2));
  const auto& run_up = found[2].variants[0].response;
  BOOST_TEST(run_up.speed[0] < 0.32);
  BOOST_TEST(run_up.speed[run_up.time.size() - 1] > 1.18);
  // At rest under the torque of the stage the planets bear its load; spectra exist where it turns.
  const auto& stop = found[3].variants[0].response;
  BOOST_TEST(stop.settled.value_or(false));
  const auto rest = (stop.time.array() < 0.25).count() - 1;
  BOOST_TEST(stop.speed[rest] == 0.0);
  BOOST_TEST(stop.mean.col(rest).head(stop.gears / 2).mean() == before, boost::test_tools::tolerance(2e-2));
  BOOST_TEST(std::isnan(stop.amplitude(1, 0)));
  BOOST_TEST((stop.amplitude.row(1).array() > 0).any());
  BOOST_TEST(stop.speed[stop.speed.size() - 1] < -0.5);
  const auto csv = Csv::read(folder.path() / "out/held/dynamics/transient_2.csv");
  BOOST_TEST(column(csv, "torque_factor").back() == 2.0);
  BOOST_TEST(Csv::read(folder.path() / "out/held/dynamics/transient_3_waterfall.csv").rows.size() > 2U);
  const auto json = nlohmann::json::parse(read_file(folder.path() / "out/summary.json"));
  const auto& of_overload = json.at("rings").at("held").at("transients").at(1);
  BOOST_TEST(of_overload.at("name") == "overload");
  BOOST_TEST(of_overload.at("results").at("course_force_factor").at("value").get<double>() > 2);
  BOOST_TEST(read_file(folder.path() / "out/report.html").find("id=\"transients\"") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(courses_that_do_not_fit_are_refused) {
  const auto refused = [&](const std::string& keys, const std::string& why) {
    try {
      (void)app::parse_scene(short_scene() + "[[transient]]\nname = \"a\"\n" + keys, "scene.toml");
      BOOST_TEST(false, why);
    } catch (const app::SceneError& error) {
      BOOST_TEST(std::string(error.what()).find(why) != std::string::npos, error.what());
    }
  };
  refused("time_s = [0]\nspeed_factor = [1]\n", "needs two times at least");
  refused("time_s = [1, 2]\nspeed_factor = [1, 1]\n", "has to rise from 0");
  refused("time_s = [0, 2, 2]\nspeed_factor = [1, 1, 1]\n", "has to rise from 0");
  refused("time_s = [0, 2]\nspeed_factor = [1]\n", "1 values for 2 times");
  refused("time_s = [0, 2]\nspeed_factor = [20, 1]\n", "speed_factor");
  refused("time_s = [0, 2]\n", "nothing changes");
}

BOOST_AUTO_TEST_CASE(sweep_points_are_the_runs_they_stand_for) {
  const test::TemporaryFolder folder("sweep");
  const auto text = two_masses(short_scene());
  const auto result = run_text(text + "[[sweep]]\ninput = \"supports.planet_N_per_m\"\nvalues = [5e8, 1e9, 2e9]\n",
                               folder.path() / "all");
  BOOST_TEST_REQUIRE(result.studies.sweeps.size() == 1U);
  const auto& sweep = result.studies.sweeps.front();
  BOOST_TEST(sweep.unit == "N/m");
  BOOST_TEST(sweep.tables == 0);
  const auto alone =
      run_text(test::replaced(text, "planet_N_per_m = 1e9", "planet_N_per_m = 2e9"), folder.path() / "alone");
  for (std::size_t ring = 0; ring < 2; ++ring) {
    // The value of the scene itself, and another one run by itself.
    BOOST_TEST(averaged(sweep.variants[ring][1]) ==
               result.rings[ring].response->figures.sun_planet.load_sharing.averaged.value);
    BOOST_TEST(averaged(sweep.variants[ring][2]) ==
               alone.rings[ring].response->figures.sun_planet.load_sharing.averaged.value);
    BOOST_TEST(sweep.variants[ring][2].value("ring_planet_load_sharing_instantaneous") ==
               alone.rings[ring].response->figures.ring_planet.load_sharing.instantaneous.value);
    // A stiffer planet bearing shares worse.
    BOOST_TEST(averaged(sweep.variants[ring][2]) > averaged(sweep.variants[ring][0]));
  }
  const auto csv = Csv::read(folder.path() / "all/heavy/dynamics/sweep_1.csv");
  BOOST_TEST(column(csv, "supports_planet_N_per_m") == (std::vector<double>{5e8, 1e9, 2e9}),
             boost::test_tools::per_element());
  BOOST_TEST(column(csv, "sun_planet_load_sharing_averaged")[2] == averaged(sweep.variants[1][2]));
  const auto poincare = Csv::read(folder.path() / "all/heavy/dynamics/sweep_1_poincare.csv");
  BOOST_TEST(poincare.rows.size() == 3U * 20);
  const auto json = nlohmann::json::parse(read_file(folder.path() / "all/summary.json"));
  BOOST_TEST(json["rings"]["heavy"]["sweeps"][0]["values"].size() == 3U);
  BOOST_TEST(read_file(folder.path() / "all/report.html").find("id=\"sweeps\"") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(grid_points_are_the_points_of_sweeps) {
  const test::TemporaryFolder folder("grid");
  const auto result = run_text(short_scene() +
                                   "[[grid]]\nx_input = \"supports.planet_N_per_m\"\nx_values = [5e8, 2e9]\n"
                                   "y_input = \"stage.power_kW\"\ny_from = 1000\ny_to = 2958.8\ny_count = 3\n"
                                   "[[sweep]]\ninput = \"supports.planet_N_per_m\"\nvalues = [5e8, 2e9]\n",
                               folder.path());
  BOOST_TEST_REQUIRE(result.studies.grids.size() == 1U);
  const auto& grid = result.studies.grids.front();
  BOOST_TEST(grid.y == (std::vector<double>{1000, (1000 + 2958.8) / 2, 2958.8}), boost::test_tools::per_element());
  BOOST_TEST_REQUIRE(grid.variants.front().size() == 6U);
  // The last row has the power of the scene.
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
    BOOST_TEST(averaged(grid.variants[0][4 + i]) == averaged(result.studies.sweeps[0].variants[0][i]));
  // Less load shares worse: the errors weigh more.
  BOOST_TEST(averaged(grid.variants[0][0]) > averaged(grid.variants[0][4]));
  const auto csv = Csv::read(folder.path() / "held/dynamics/grid_1.csv");
  BOOST_TEST(column(csv, "supports_planet_N_per_m") == (std::vector<double>{5e8, 2e9, 5e8, 2e9, 5e8, 2e9}),
             boost::test_tools::per_element());
  const auto report = read_file(folder.path() / "report.html");
  BOOST_TEST(report.find("id=\"grids\"") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(inputs_of_the_bodies_solve_tables_of_their_own) {
  const test::TemporaryFolder folder("tables");
  auto text = test::replaced(
      short_scene(), "[mesh.ring_planet]\nstiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294\n", "");
  text = test::replaced(text, "teeth = 55\n", "teeth = 55\nbore_diameter_mm = 172\n");
  text =
      test::replaced(text, "structure = \"traditional\"", "structure = \"pinned\"\npins = 27\npin_diameter_mm = 15.5");
  text = test::replaced(text, "title = \"Quick\"", "title = \"Quick\"\nmodel = \"closed_form\"");
  text = test::replaced(text, "mesh_cycles = 20", "mesh_cycles = 6");
  const auto result = run_text(text +
                                   "[[sweep]]\ninput = \"ring.pins\"\nvalues = [27, 18]\n"
                                   "[[sweep]]\ninput = \"stage.power_kW\"\nvalues = [2000, 9000]\n",
                               folder.path() / "all");
  // 27 pins are the scene's own table; half the power lies within it, three times the power does not.
  BOOST_TEST(result.studies.sweeps[0].tables == 1);
  BOOST_TEST(result.studies.sweeps[1].tables == 1);
  BOOST_TEST(std::filesystem::exists(folder.path() / "all/sweep/ring_pins/18/held/stiffness_ring_planet.csv"));
  BOOST_TEST(!std::filesystem::exists(folder.path() / "all/sweep/ring_pins/27"));
  BOOST_TEST(std::filesystem::exists(folder.path() / "all/sweep/stage_power_kW/9000/held/stiffness_ring_planet.csv"));
  const auto alone = run_text(test::replaced(text, "pins = 27", "pins = 18"), folder.path() / "alone");
  BOOST_TEST(result.studies.sweeps[0].variants[0][1].value("ring_planet_load_sharing_averaged") ==
             alone.rings[0].response->figures.ring_planet.load_sharing.averaged.value);
  BOOST_TEST(result.studies.sweeps[0].variants[0][0].value("ring_planet_load_sharing_averaged") !=
             result.studies.sweeps[0].variants[0][1].value("ring_planet_load_sharing_averaged"));
}

BOOST_AUTO_TEST_CASE(samples_are_the_same_for_any_number_of_threads_and_samples) {
  const test::TemporaryFolder folder("threads");
  const auto text = two_masses(short_scene());
  const auto file = [&](const char* run, const char* ring) {
    return folder.path() / run / ring / "dynamics/monte_carlo.csv";
  };
  const auto one = run_text(text + few_samples, folder.path() / "one", 1);
  (void)run_text(text + few_samples, folder.path() / "three", 3);
  for (const auto* ring : {"held", "heavy"}) BOOST_TEST(read_file(file("one", ring)) == read_file(file("three", ring)));
  // Fewer samples first: the later ones add to them.
  const auto fewer = test::replaced(text + few_samples, "samples = 45", "samples = 25");
  (void)run_text(fewer, folder.path() / "more");
  const auto early = Csv::read(file("more", "held"));
  BOOST_TEST(early.rows.size() == 25U);
  const auto more = run_text(text + few_samples, folder.path() / "more").reuse->counted(app::study_responses);
  BOOST_TEST(more.reused == 2 * 25);  // of two rings
  BOOST_TEST(more.computed == 2 * 20);
  BOOST_TEST(read_file(file("more", "held")) == read_file(file("one", "held")));
  // And fewer again are the first of them.
  (void)run_text(fewer, folder.path() / "more");
  BOOST_TEST((Csv::read(file("more", "held")).rows == early.rows));
  // Both rings have the same draws; another seed has others.
  const auto& samples = one.studies.monte_carlo->variants;
  const std::string phase = "errors_planet_pin_position_error_phase_deg_3";
  BOOST_TEST(column(samples[0].samples, phase) == column(samples[1].samples, phase), boost::test_tools::per_element());
  const auto seeded = run_text(test::replaced(text + few_samples, "seed = 5", "seed = 6"), folder.path() / "one");
  BOOST_TEST(column(seeded.studies.monte_carlo->variants[0].samples, phase)[0] != column(samples[0].samples, phase)[0]);
}

BOOST_AUTO_TEST_CASE(interrupted_studies_go_on_to_the_same_bytes) {
  const test::TemporaryFolder folder("interrupted");
  auto text = short_scene() + "[[sweep]]\ninput = \"stage.sun_speed_rpm\"\nfrom = 800\nto = 1200\ncount = 5\n" +
              "[monte_carlo]\nsamples = 120\n[sensitivity]\ninputs = [\"supports.sun_N_per_m\"]\n";
  write_file(folder.path() / "scene.toml", text);
  BOOST_TEST(test::BackgroundRun(folder.path(), "whole").wait() == 0);
  const auto first = folder.path() / "parts/cache/samples";
  BOOST_TEST(test::BackgroundRun(folder.path(), "parts").kill_when_there(first));
  BOOST_TEST_REQUIRE(std::filesystem::exists(first));
  BOOST_TEST(!std::filesystem::exists(folder.path() / "parts/sensitivity.csv"));
  BOOST_TEST(test::BackgroundRun(folder.path(), "parts", 1).wait() == 0);
  const auto reuse = nlohmann::json::parse(read_file(folder.path() / "parts/summary.json"))["reuse"]["counts"];
  BOOST_TEST(reuse[app::study_responses]["reused"].get<int>() > 0);  // taken over, not made again
  for (const auto* file : {"held/dynamics/sweep_1.csv", "held/dynamics/sweep_1_poincare.csv",
                           "held/dynamics/monte_carlo.csv", "sensitivity.csv"})
    BOOST_TEST(read_file(folder.path() / "whole" / file) == read_file(folder.path() / "parts" / file), file);
}

BOOST_AUTO_TEST_CASE(two_planets_of_unknown_phase_have_a_known_spread) {
  // Two planets, all centres held, constant stiffness: L = 1 + K |e_1 - e_2| / (2 F). Installation errors of amount A
  // make e_n = B sin(theta_n - ...) with B = 2 A cos((a_s + a_r)/2), and uniform phases make e_n independent with
  // E |e_1 - e_2| = 8 B / pi^2 and E (e_1 - e_2)^2 = B^2.
  auto text = test::replaced(short_scene(), "planets = 5", "planets = 2");
  text = test::replaced(test::replaced(text, "[15, 36, 17, 38, 19]", "[20, 20]"), "[0, 0, 0, 0, 0]", "[0, 0]");
  text = test::replaced(text, "sun_N_per_m = 1e7\n", "sun_N_per_m = \"rigid\"\n");
  for (const auto* ripple : {"ripple = 0.2258\n", "ripple = 0.1294\n"}) {
    text = test::replaced(text, ripple, "");
    text = test::replaced(text, "\"harmonic\"", "\"constant\"");
  }
  const test::TemporaryFolder folder("two_planets");
  const auto result = run_text(text + "[monte_carlo]\nsamples = 200\n", folder.path());
  const auto& set = result.geometry.rings.front().set;
  const double a = set.sun_mesh().working_pressure_angle(), r = set.ring_mesh().working_pressure_angle();
  const double path = 1 / (1 / 1.364e9 + 1 / 1.87e9 +
                           (std::pow(std::cos(a) + std::cos(r), 2) + std::pow(std::sin(a) - std::sin(r), 2)) / 1e9);
  const double scale = path * 2 * 20e-6 * std::cos((a + r) / 2) / 2 / result.geometry.operating_point.mean_mesh_force;
  const auto& ring = result.studies.monte_carlo->variants.front();
  BOOST_TEST(ring.failed == 0);
  // 200 samples: four standard errors of the mean, sqrt((1 - (8/pi^2)^2)/200) of the scale each.
  constexpr double mean = 8 / (std::numbers::pi * std::numbers::pi);
  for (const auto* figure : {"sun_planet_load_sharing_quasi_static", "ring_planet_load_sharing_averaged"}) {
    const auto* s = ring.find(figure);
    BOOST_TEST_REQUIRE(s);
    BOOST_TEST(std::abs((s->mean.value - 1) / scale - mean) < 4 * std::sqrt((1 - mean * mean) / 200));
    BOOST_TEST(s->mean.low < s->mean.value);
    BOOST_TEST((s->q05.value < s->median.value && s->median.value < s->q95.value));
    // Rounding, the integrator and the centripetal terms aside no sample exceeds 2 B: L <= 1 + 2 scale.
    for (const double x : column(ring.samples, figure)) BOOST_TEST((x > 1 - 1e-4 && x < 1 + 2.01 * scale));
  }
  // Every sample by itself: the closed form at the phases it says it drew.
  const auto phase1 = column(ring.samples, "errors_planet_pin_position_error_phase_deg_1"),
             phase2 = column(ring.samples, "errors_planet_pin_position_error_phase_deg_2"),
             sharing = column(ring.samples, "sun_planet_load_sharing_quasi_static");
  for (std::size_t i = 0; i < sharing.size(); ++i) {
    const double shift = (a - r) / 2;  // planets at 0 and 180 degrees
    const double difference =
        std::sin(phase1[i] * units::deg + shift) - std::sin(phase2[i] * units::deg - std::numbers::pi + shift);
    BOOST_TEST(std::abs(sharing[i] - (1 + scale * std::abs(difference))) < 2e-4);
  }
}

BOOST_AUTO_TEST_CASE(orders_of_the_rings_are_counted_in_pairs) {
  const test::TemporaryFolder folder("orders");
  const auto result = run_text(two_masses(short_scene()) + few_samples, folder.path());
  const auto& found = *result.studies.monte_carlo;
  BOOST_TEST_REQUIRE(found.orders.size() == 3U);
  const auto& order = found.orders.front();
  BOOST_TEST(order.figure == ordering_figure);
  const auto a = column(found.variants[0].samples, order.figure), b = column(found.variants[1].samples, order.figure);
  long above = 0;
  double difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    above += a[i] > b[i] ? 1 : 0;
    difference += (a[i] - b[i]) / 45;
  }
  BOOST_TEST(order.samples == 45);
  BOOST_TEST(order.above == above);
  BOOST_TEST((order.share.low <= above / 45.0 && above / 45.0 <= order.share.high));
  BOOST_TEST(order.difference.value == difference, boost::test_tools::tolerance(1e-9));
  const auto json = nlohmann::json::parse(read_file(folder.path() / "summary.json"));
  BOOST_TEST(json["monte_carlo"]["orders"][0]["share"]["value"] == order.share.value);
  const auto& statistics = json["rings"]["held"]["monte_carlo"];
  BOOST_TEST(statistics["samples"] == 45);
  BOOST_TEST(statistics["failed"] == 0);
  BOOST_TEST(statistics[ordering_figure]["mean"]["value"].get<double>() > 1);
  const auto page = read_file(folder.path() / "report.html");
  BOOST_TEST(page.find("id=\"spread\"") != std::string::npos);
  BOOST_TEST(page.find(">nan<") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(failed_samples_are_counted_and_told) {
  // The failing draws are those of a power for which the given table has no load.
  const test::TemporaryFolder folder("failed");
  std::vector<StiffnessEntry> entries;
  for (int phase = 0; phase < 8; ++phase) {
    for (const double load : {4e4, 6e4})
      entries.push_back({.unloaded_te = 0,
                         .lte = load / 1.8e9,
                         .stiffness_secant = 1.8e9,
                         .stiffness_tangent = 1.8e9,
                         .error_relative = 0.01});
  }
  StiffnessTable("ring_planet", 8, {0.0}, {4e4, 6e4}, entries).write_csv(folder.path() / "ring.csv");
  const auto text = test::replaced(short_scene(), "stiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294",
                                   "stiffness = \"table\"\nfile = \"ring.csv\"");
  write_file(folder.path() / "scene.toml",
             text + few_samples +
                 "[[monte_carlo.input]]\ninput = \"stage.power_kW\"\ndistribution = \"uniform\"\n"
                 "low = 2500\nhigh = 3200\n");
  const auto result = app::run(app::read_scene(folder.path() / "scene.toml"), {.out = folder.path() / "out"});
  const auto& ring = result.studies.monte_carlo->variants.front();
  // 59.46 kN at 2958.8 kW: 60 kN are passed above 2985.7 kW.
  const auto power = column(ring.samples, "stage_power_kW"), failed = column(ring.samples, "failed");
  int expected = 0;
  for (std::size_t i = 0; i < power.size(); ++i) {
    BOOST_TEST((failed[i] == 1) == (power[i] > 2985.7), power[i]);
    expected += power[i] > 2985.7 ? 1 : 0;
  }
  BOOST_TEST(expected > 0);
  BOOST_TEST(ring.failed == expected);
  BOOST_TEST(std::isfinite(ring.find(ordering_figure)->mean.value));
  const auto csv = Csv::read(folder.path() / "out/held/dynamics/monte_carlo.csv");
  BOOST_TEST(csv.header.size() == 2U + static_cast<std::size_t>(expected));
  BOOST_TEST(read_file(folder.path() / "out/report.html").find("responses failed and are left out") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(sensitivity_divides_and_multiplies) {
  const test::TemporaryFolder folder("sensitivity");
  const auto text = two_masses(short_scene());
  const auto result = run_text(text + "[sensitivity]\n", folder.path() / "all");
  const auto& s = *result.studies.sensitivity;
  std::vector<std::string> inputs;
  for (const auto& row : s.rows) inputs.push_back(row.input);
  const std::vector<std::string> expected = {"supports.sun_N_per_m",        "supports.ring_N_per_m",
                                             "supports.planet_N_per_m",     "dynamics.half_backlash_um",
                                             "dynamics.mesh_damping_ratio", "dynamics.support_damping_ratio"};
  BOOST_TEST(inputs == expected, boost::test_tools::per_element());
  const auto halved =
      run_text(test::replaced(text, "planet_N_per_m = 1e9", "planet_N_per_m = 0.5e9"), folder.path() / "alone");
  for (std::size_t ring = 0; ring < 2; ++ring) {
    BOOST_TEST(averaged(s.nominal[ring]) ==
               result.rings[ring].response->figures.sun_planet.load_sharing.averaged.value);
    BOOST_TEST(averaged(s.rows[2].divided[ring]) ==
               halved.rings[ring].response->figures.sun_planet.load_sharing.averaged.value);
    BOOST_TEST(s.rows[2].values[ring] == 1e9);
    // While no mesh separates, the backlash changes nothing (docs/backlash_optimisation.md [WangLiYaoYi2016]), up to
    // the integrator's tolerance.
    BOOST_TEST(averaged(s.rows[3].multiplied[ring]) == averaged(s.nominal[ring]), boost::test_tools::tolerance(1e-5));
  }
  for (const auto& row : s.rows) {
    const auto order = [&](const std::vector<app::StudyPoint>& p) { return averaged(p[0]) > averaged(p[1]); };
    BOOST_TEST(row.order_stays ==
               (order(row.divided) == order(s.nominal) && order(row.multiplied) == order(s.nominal)));
  }
  const auto csv = read_file(folder.path() / "all/sensitivity.csv");
  BOOST_TEST(std::count(csv.begin(), csv.end(), '\n') == 2 + 1 + 6 * 2);
  const auto json = nlohmann::json::parse(read_file(folder.path() / "all/summary.json"));
  BOOST_TEST(json["sensitivity"]["inputs"].size() == 6U);
}

BOOST_AUTO_TEST_CASE(the_plan_counts_what_is_to_come) {
  const auto scene = app::parse_scene(two_masses(short_scene()) +
                                          "[[sweep]]\ninput = \"stage.power_kW\"\nfrom = 1\nto = 9\ncount = 9\n" +
                                          few_samples + "[sensitivity]\n",
                                      "s");
  const auto plan = app::make_plan(scene);
  BOOST_TEST_REQUIRE(plan.studies.size() == 3U);
  BOOST_TEST(plan.studies[0].responses == 18);
  BOOST_TEST(plan.studies[1].responses == 90);
  BOOST_TEST(plan.studies[2].responses == 26);
  for (const auto& study : plan.studies) {
    BOOST_TEST(study.tables == 0);
    BOOST_TEST(study.seconds > 0);
  }
  BOOST_TEST(app::to_text(plan).find("[monte_carlo]: 45 samples of 5 random inputs") != std::string::npos);
  BOOST_TEST(app::to_json(plan).at("studies").at(0).at("responses").get<int>() == 18);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
