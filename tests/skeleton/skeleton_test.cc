#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/model/run_options.h"
#include "app/model/system_run.h"
#include "app/run/pipeline.h"
#include "app/scene/new_scene.h"
#include "app/scene/scene_schema.h"
#include "app/systems/skeleton/torsional_pair.h"
#include "app/tradeoff/tradeoff.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "tests/temporary_folder.h"

/// The gear system to copy, as a user of a new kind sees it: nothing else of the program was changed for it.
namespace annulus {

namespace {

/// Before the first scene is read.
const bool registered = [] {
  app::register_system(app::torsional_pair_kind());
  return true;
}();

std::string scene_text() {
  log::set_level(log::Level::quiet);
  return app::scene_kind("torsional_pair").example;
}

const std::string prescribed =
    "[mesh.pinion_wheel]\nstiffness = \"constant\"\nmean_N_per_m = 4e8\n"
    "[[sweep]]\ninput = \"mesh.pinion_wheel.mean_N_per_m\"\nvalues = [1e8, 4e8]\n"
    "[[monte_carlo.input]]\ninput = \"pinion.inertia_kg_m2\"\ndistribution = \"normal\"\nmean = 0.002\n"
    "deviation = 1e-5\n[monte_carlo]\nsamples = 30\n";

/// Hz, of the example with this mean stiffness, by hand: base radii 48 mm cos 20° and 72 mm cos 20°.
double frequency(double stiffness) {
  const double cosine = std::cos(20 * std::numbers::pi / 180);
  const double pinion = 0.003 / std::pow(0.048 * cosine, 2), wheel = 0.01 / std::pow(0.072 * cosine, 2);
  return std::sqrt(stiffness * (1 / pinion + 1 / wheel)) / (2 * std::numbers::pi);
}

std::shared_ptr<const app::SystemRun> run(const std::string& text, const std::filesystem::path& out) {
  const auto scene = app::parse_scene(text, "scene.toml");
  app::check_stage(scene);
  return app::run_system(scene, {.out = out, .threads = 2});
}

}  // namespace

BOOST_AUTO_TEST_SUITE(skeleton)

/// The first case: it needs a process without threads, which the others leave behind.
BOOST_AUTO_TEST_CASE(the_cost_study_is_that_of_every_kind,
                     *boost::unit_test::precondition([](boost::unit_test::test_unit_id) {
                       return app::has_its_first_threads_alone();
                     })) {
  const test::TemporaryFolder folder("skeleton_tradeoff");
  app::TradeLists lists;
  lists.accuracies = {0.1};
  lists.mesh = [](const app::MeshModel&, app::AlongFace face) {
    BOOST_TEST((face == app::AlongFace::uniform));
    return std::vector<app::MeshSetting>{
        {.fidelity = fem::Fidelity::plane, .degree = 1, .level = 1, .phases = 8, .loads = 1},
        {.fidelity = fem::Fidelity::plane, .degree = 2, .level = 1, .phases = 8, .loads = 1, .finest = true}};
  };
  const auto trade =
      app::measure_tradeoff(app::parse_scene(scene_text(), "scene.toml"), {.out = folder.path(), .threads = 1}, lists);
  BOOST_TEST_REQUIRE(trade.variants.size() == 1U);
  BOOST_TEST(trade.variants.front().name == "torsional_pair");
  const auto& points = trade.variants.front().points;
  BOOST_TEST_REQUIRE(points.size() == 3U);
  for (const auto& p : points) BOOST_TEST_REQUIRE(p.failure == "", p.settings << ": " << p.failure);
  // A frequency follows the root of the stiffness.
  const auto& stiff = points.front();
  const double stiffness = stiff.find("pinion_wheel_mean_stiffness_N_per_m")->value /
                           points[1].find("pinion_wheel_mean_stiffness_N_per_m")->value;
  const auto* hertz = stiff.find("natural_frequency_Hz");
  BOOST_TEST_REQUIRE(hertz != nullptr);
  BOOST_TEST(hertz->error == std::sqrt(stiffness) - 1, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(hertz->error_estimate > 0);
  // A prescribed stiffness leaves nothing to measure: this kind offers no ways to its motion.
  BOOST_CHECK_THROW((void)app::measure_tradeoff(app::parse_scene(scene_text() + prescribed, "scene.toml"),
                                                {.out = folder.path() / "prescribed", .threads = 1}),
                    InputError);
}

BOOST_AUTO_TEST_CASE(a_scene_is_read_checked_and_planned) {
  BOOST_TEST(registered);
  const auto scene = app::parse_scene(scene_text(), "scene.toml");
  BOOST_TEST(app::make_system(scene)->describe() == "torsional pair, 24 and 36 teeth");
  const auto plan = app::to_text(app::make_plan(scene));
  for (const auto* part : {"mesh force along the line of action", "pinion u"})
    BOOST_TEST(plan.find(part) != std::string::npos, part);
  // New scenes, keys of its own and their refusal come from its tables alone.
  BOOST_TEST(app::new_scene("torsional_pair", app::example_values("torsional_pair")).find("[drive]") !=
             std::string::npos);
  BOOST_TEST(app::find_parameter("drive.inertia_kg_m2") != nullptr);
  auto wrong = scene_text();
  wrong.replace(wrong.find("[drive]\ninertia_kg_m2 = 0.001"), 29, "[drive]\ninertia_kg_m2 = -1");
  BOOST_CHECK_THROW((void)app::parse_scene(wrong, "scene.toml"), InputError);
}

BOOST_AUTO_TEST_CASE(results_studies_and_files_are_those_of_every_kind) {
  const test::TemporaryFolder folder("skeleton_prescribed");
  const auto result = run(scene_text() + prescribed, folder.path());
  const auto figures = result->variants().front().figures;
  BOOST_TEST(figures.value("natural_frequency_Hz") == frequency(4e8), boost::test_tools::tolerance(1e-12));
  const double force = 300 / (0.048 * std::cos(20 * std::numbers::pi / 180));
  BOOST_TEST(figures.value("static_deflection_m") == force / 4e8, boost::test_tools::tolerance(1e-12));
  const auto sweep = Csv::read(folder.path() / "dynamics/sweep_1.csv");
  const auto column = sweep.column("natural_frequency_Hz");
  BOOST_TEST(sweep.rows.at(0)[column] == frequency(1e8), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(result->studies.monte_carlo->variants.front().statistics.size() == 2U);
  const auto summary = nlohmann::json::parse(read_file(folder.path() / "summary.json"));
  BOOST_TEST(summary["kind"] == "torsional_pair");
  BOOST_TEST(read_file(folder.path() / "figures.csv").find("natural_frequency_Hz") != std::string::npos);
  BOOST_TEST(app::run_text(*result).find("Natural frequency") != std::string::npos);
  for (const auto* part : {"Deflection of the mesh", "Model, with reasons", "Spread over unknown inputs"})
    BOOST_TEST(read_file(folder.path() / "report.html").find(part) != std::string::npos, part);
}

BOOST_AUTO_TEST_CASE(a_computed_mesh_carries_its_error_into_the_results) {
  const test::TemporaryFolder folder("skeleton_computed");
  const auto text = scene_text() + "[[sweep]]\ninput = \"stage.pinion_torque_Nm\"\nvalues = [200, 900]\n";
  const auto result = run(text, folder.path());
  const auto figures = result->variants().front().figures;
  const auto stiffness = figures.figure("pinion_wheel_mean_stiffness_N_per_m"),
             hertz = figures.figure("natural_frequency_Hz");
  BOOST_TEST(hertz.value == frequency(stiffness.value), boost::test_tools::tolerance(1e-9));
  // A square root halves the relative error; interpolation adds to it.
  const double half = stiffness.error / stiffness.value / 2;
  BOOST_TEST(hertz.error / hertz.value >= 0.95 * half);
  BOOST_TEST(hertz.error / hertz.value <= 2 * half);
  BOOST_TEST(result->reuse->counted(app::study_meshes).computed == 1);  // the second torque is beyond the table
  const auto again = run(text, folder.path());
  BOOST_TEST(again->reuse->computed().empty());
  BOOST_TEST(again->reuse->counted(app::study_meshes).reused == 1);
  BOOST_TEST(again->variants().front().figures.value("natural_frequency_Hz") == hertz.value);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
