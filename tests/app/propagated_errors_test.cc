#include "app/systems/planetary/propagated_errors.h"
#include "app/model/gear_system.h"
#include "app/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/report/page.h"
#include "app/run/pipeline.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "app/systems/planetary/stage_modes.h"
#include "app/systems/shared/mesh_names.h"
#include "core/files.h"
#include "core/log.h"
#include "dynamics/systems/planetary/planetary_figures.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

/// Tables k (1 + ripple cos) of both meshes with one relative error each, and a scene on them. Installation errors
/// alone: they stand still on the carrier, so the windows are short.
struct TableScene {
  int planets = 5, phases = 16;
  double sun_error = 0.01, ring_error = 0.01, ripple = 0.2;
  bool held = false;  ///< the sun's centre
  int positions = 1;  ///< of the ring, whose stiffness then changes from tooth to tooth by a tenth
  std::string pins = "15, 36, 17, 38, 19";  ///< µm, their errors
  std::string half_backlash = "50";         ///< µm
  ErrorParts sun_parts{}, ring_parts{};
  static constexpr double sun = 1.364e9, ring = 1.87e9, bearing = 1e9;  ///< N/m

  [[nodiscard]] StiffnessTable table(const char* mesh, double mean, double error, const ErrorParts& parts) const {
    std::vector<StiffnessEntry> entries;
    const int there = std::string(mesh) == "ring_planet" ? positions : 1;
    std::vector<double> angles;
    for (int position = 0; position < there; ++position) {
      angles.push_back(position * 2 * std::numbers::pi / 81);
      for (int phase = 0; phase < phases; ++phase) {
        const double cycles = position + static_cast<double>(phase) / phases;
        const double k = mean * (1 + ripple * std::cos(2 * std::numbers::pi * cycles) +
                                 (there > 1 ? 0.1 * std::sin(2 * std::numbers::pi * cycles / there) : 0));
        for (const double load : {2e4, 2e5}) entries.push_back({0, load / k, k, k, error, parts});
      }
    }
    return {mesh, phases, angles, {2e4, 2e5}, entries};
  }
  [[nodiscard]] app::RunResult run(const std::filesystem::path& folder) const {
    auto text = test::replaced(
        test::quick_scene(), test::quick_errors(),
        planets == 2 ? "planet_pin_position_error_um = [20, 20]\nplanet_pin_position_error_phase_deg = [0, 0]\n"
                     : "planet_pin_position_error_um = [" + pins +
                           "]\n"
                           "planet_pin_position_error_phase_deg = [0, 0, 0, 0, 0]\n");
    // Motions are compared to a thousandth of L - 1, which is some thousandths itself.
    text = test::replaced(text, "mesh_cycles = 110\n", "relative_tolerance = 1e-6\n");
    text = test::replaced(text, "planets = 5", "planets = " + std::to_string(planets));
    text = test::replaced(text, "half_backlash_um = 50", "half_backlash_um = " + half_backlash);
    if (held) text = test::replaced(text, "sun_N_per_m = 1e7\n", "sun_N_per_m = \"rigid\"\n");
    text = test::replaced(text, "stiffness = \"harmonic\"\nmean_N_per_m = 1.364e9\nripple = 0.2258",
                          "stiffness = \"table\"\nfile = \"sun.csv\"");
    text = test::replaced(text, "stiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294",
                          "stiffness = \"table\"\nfile = \"ring.csv\"");
    table("sun_planet", sun, sun_error, sun_parts).write_csv(folder / "sun.csv");
    table("ring_planet", ring, ring_error, ring_parts).write_csv(folder / "ring.csv");
    write_file(folder / "scene.toml", text);
    log::set_level(log::Level::quiet);
    return app::run(app::read_scene(folder / "scene.toml"), {.out = folder / "out"});
  }
};

/// The error of the tables themselves, whose parts are not known.
double of_stiffness(const ErrorParts& e) { return e.discretisation + e.contact + e.condensation + e.model; }

struct Pair {
  std::string key;
  Figure figure;
  ErrorParts errors;
};

/// Without times without contact, which are zero in most of these stages, and their errors with them.
std::vector<Pair> pairs(const app::StageResponse& r) {
  std::vector<Pair> list;
  dynamics::for_each_figure(r.figures, [&](const std::string& key, const Figure& figure) {
    if (!key.ends_with("contact_loss")) list.push_back({key, figure, r.errors.find(key)->parts});
  });
  for (const auto& [key, figure, parts, spread] : r.figures.bodies.entries())
    list.push_back({key, figure, r.errors.find(key)->parts});
  return list;
}

ErrorParts errors_of(const std::vector<Pair>& pairs, const std::string& key) {
  const auto found = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& pair) { return pair.key == key; });
  BOOST_TEST_REQUIRE((found != pairs.end()), key);
  return found->errors;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(propagated_errors)

BOOST_AUTO_TEST_CASE(frequencies_carry_the_errors_of_the_stiffness) {
  // Against the frequencies of stages whose stiffness is larger by its error.
  const test::TemporaryFolder folder("frequency_errors");
  const TableScene base{.sun_error = 2e-4, .ring_error = 1e-4};
  const auto modes_of = [&](double sun, double ring) {
    const auto scene = app::parse_scene(
        test::replaced(test::replaced(test::quick_scene(), "1.364e9", fmt::format("{:.17g}", TableScene::sun * sun)),
                       "1.87e9", fmt::format("{:.17g}", TableScene::ring * ring)),
        "scene.toml");
    const auto geometry = app::make_geometry(scene);
    const auto plan = app::make_plan(scene);
    const auto mesh = [&](std::size_t i) {
      return app::mesh_stiffness(scene, geometry, plan.meshes[i], {.out = folder.path()});
    };
    return app::stage_modes(app::make_stage(scene, geometry, 0, mesh(0), mesh(1)),
                            {{.groups = {app::sun_planet}, .relative = base.sun_error},
                             {.groups = {app::ring_planet}, .relative = base.ring_error}});
  };
  const auto nominal = modes_of(1, 1), stiffer = modes_of(1 + base.sun_error, 1 + base.ring_error);
  BOOST_TEST_REQUIRE(nominal.list.size() > 10U);
  int moved = 0;
  for (std::size_t i = 0; i < nominal.list.size(); ++i) {
    const double error = nominal.list[i].frequency_error, shift = stiffer.list[i].frequency - nominal.list[i].frequency;
    // The change of first order; the next one is smaller by the error itself.
    BOOST_TEST(std::abs(shift - error) <= 1e-3 * error + 1e-9 * nominal.list[i].frequency);
    moved += error > 1e-5 * nominal.list[i].frequency;
  }
  BOOST_TEST(moved >= 5);
}

// Pins of a ring are not where its table has them when back flanks carry; nothing else is uncertain here.
BOOST_AUTO_TEST_CASE(back_flanks_of_a_changing_ring_bring_an_error_of_the_model) {
  const test::TemporaryFolder folder("back_flank_errors");
  const auto model_part = [&](const TableScene& scene) {
    const auto result = scene.run(folder.path());
    const auto& response = *result.rings.front().response;
    const auto& branches = response.figures.ring_planet.branches;
    const bool back = std::any_of(branches.begin(), branches.end(), [](const auto& b) { return b.back_flanks > 0; });
    BOOST_TEST(back == (scene.pins != TableScene().pins));
    double largest = 0;
    for (const auto& pair : pairs(response)) largest = std::max(largest, pair.errors.model);
    return largest;
  };
  const TableScene exact{.sun_error = 0, .ring_error = 0, .held = true};
  auto still = exact, turned = exact, both = exact;
  still.pins = both.pins = "0, 0, 0, 520, 0";
  still.half_backlash = "0";
  turned.positions = both.positions = 3;
  BOOST_TEST(model_part(still) == 0.0);
  BOOST_TEST(model_part(turned) == 0.0);
  for (const auto* half_backlash : {"50", "0"}) {
    both.half_backlash = half_backlash;
    BOOST_TEST(model_part(both) > 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(frequencies_carry_the_error_of_the_elastic_ring) {
  // Against the frequencies of a stage whose ring is stiffer: its modes are higher by their error.
  constexpr double error = 1e-5;
  const auto scene = app::parse_scene(test::quick_scene(), "scene.toml");
  const auto geometry = app::make_geometry(scene);
  const auto plan = app::make_plan(scene);
  const test::TemporaryFolder folder("ring_mode_errors");
  const auto mesh = [&](std::size_t i) {
    return app::mesh_stiffness(scene, geometry, plan.meshes[i], {.out = folder.path()});
  };
  const auto modes_of = [&](double factor) {
    auto stage = app::make_stage(scene, geometry, 0, mesh(0), mesh(1));
    auto coupling = std::make_shared<RingCoupling>();
    coupling->planets = stage.planets();
    coupling->ring_teeth = stage.ring_teeth;
    coupling->load = stage.mean_mesh_force();
    coupling->mass = 30;
    coupling->rotational_mass = 40;
    coupling->compliance.emplace_back(Eigen::MatrixXd::Zero(stage.planets(), stage.planets()));
    for (const int k : {0, 1}) {
      RingMode mode{.frequency = factor * 1500, .waves = 2, .deflection = {}};
      for (int tooth = 0; tooth < stage.ring_teeth; ++tooth)
        mode.deflection.push_back(0.05 * std::cos(2 * M_PI * (2.0 * tooth / stage.ring_teeth - k / 4.0)));
      coupling->modes.push_back(std::move(mode));
    }
    stage.ring_coupling = std::move(coupling);
    return app::stage_modes(
        stage,
        {{.groups = {"ring_mode", "ring_body"}, .relative = error, .parts = {.model = error}, .sensitivity = 1}});
  };
  const auto nominal = modes_of(1), higher = modes_of(1 + error);
  // Modes of nearly the same frequency change into each other: only their sum is of first order.
  double shift = 0, stated = 0, most = 0;
  for (std::size_t i = 0; i < nominal.list.size(); ++i) {
    const auto& mode = nominal.list[i];
    BOOST_TEST(mode.error_parts.total() == mode.frequency_error, boost::test_tools::tolerance(1e-12));
    shift += higher.list[i].frequency - mode.frequency;
    stated += mode.frequency_error;
    most = std::max(most, stated);
    if (i + 1 < nominal.list.size() && nominal.list[i + 1].frequency < 1.01 * mode.frequency) continue;
    // The next order is smaller by the error over the distance to the next mode; and rounding.
    BOOST_TEST(std::abs(std::abs(shift) - stated) <= 1e-2 * stated + 1e-8 * mode.frequency);
    shift = stated = 0;
  }
  BOOST_TEST(most > error * 1000);
}

BOOST_AUTO_TEST_CASE(errors_are_the_sum_of_their_parts_and_are_kept) {
  const test::TemporaryFolder folder("errors_kept");
  const TableScene scene;
  const auto first = scene.run(folder.path());
  const auto parts = pairs(*first.rings[0].response);
  BOOST_TEST(parts.size() == 49U);
  for (const auto& [key, figure, e] : parts) {
    BOOST_TEST(figure.error == e.integration + of_stiffness(e) + e.interpolation, boost::test_tools::tolerance(1e-13));
    BOOST_TEST(e.discretisation > 0);
    BOOST_TEST(e.contact + e.condensation + e.model == 0);
    BOOST_TEST(e.interpolation > 0);
  }
  const auto second = scene.run(folder.path());
  BOOST_TEST_REQUIRE(second.rings[0].response->reused);
  const auto kept = pairs(*second.rings[0].response);
  BOOST_TEST_REQUIRE(kept.size() == parts.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    BOOST_TEST(kept[i].figure.error == parts[i].figure.error);
    for (const auto& [name, part] : error_part_names)
      BOOST_TEST((kept[i].errors.*part) == (parts[i].errors.*part), name);
  }
  std::ifstream in(folder.path() / "out/summary.json");
  const auto ring = nlohmann::json::parse(in)["rings"]["held"];
  BOOST_TEST(ring["load_sharing"]["sun_planet"]["instantaneous"]["error_parts"]["discretisation"].get<double>() ==
             errors_of(parts, "sun_planet_load_sharing_instantaneous").discretisation);
  BOOST_TEST(ring["peak_factor_error_parts"]["ring_planet"][4]["table_interpolation"].get<double>() ==
             errors_of(parts, "ring_planet5_peak_factor").interpolation);
  BOOST_TEST(app::html(app::key_results(first, {{"", ""}}, "")).find("Parts of the error bars") != std::string::npos);
  // Another error is another response.
  BOOST_TEST(!TableScene{.sun_error = 0.02}.run(folder.path()).rings[0].response->reused);
}

BOOST_AUTO_TEST_CASE(errors_are_divided_as_those_of_the_tables) {
  // Three parts of the ring mesh's error, one of the sun mesh's: a figure's error by either has the same shares.
  const test::TemporaryFolder folder("errors_divided");
  const TableScene by_sun{.ring_error = 0}, by_ring{.sun_error = 0};
  TableScene divided;
  divided.sun_parts.model = divided.sun_error;
  divided.ring_parts.discretisation = 0.5 * divided.ring_error;
  divided.ring_parts.contact = 0.3 * divided.ring_error;
  divided.ring_parts.condensation = 0.2 * divided.ring_error;
  const auto all = pairs(*divided.run(folder.path()).rings[0].response);
  const auto sun = pairs(*by_sun.run(folder.path()).rings[0].response);
  const auto ring = pairs(*by_ring.run(folder.path()).rings[0].response);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto near = boost::test_tools::tolerance(1e-6);
    const auto& e = all[i].errors;
    BOOST_TEST(e.model == of_stiffness(sun[i].errors), near);
    BOOST_TEST(e.discretisation == 0.5 * of_stiffness(ring[i].errors), near);
    BOOST_TEST(e.contact == 0.3 * of_stiffness(ring[i].errors), near);
    BOOST_TEST(e.condensation == 0.2 * of_stiffness(ring[i].errors), near);
  }
}

BOOST_AUTO_TEST_CASE(exact_tables_leave_the_interpolation) {
  const test::TemporaryFolder folder("errors_exact");
  for (const auto& [key, figure, e] :
       pairs(*TableScene{.sun_error = 0, .ring_error = 0}.run(folder.path()).rings[0].response)) {
    BOOST_TEST(of_stiffness(e) == 0);
    BOOST_TEST(e.interpolation > 0);
  }
}

BOOST_AUTO_TEST_CASE(an_odd_number_of_phases_tells_nothing_about_the_interpolation) {
  const test::TemporaryFolder folder("errors_odd");
  const auto result = TableScene{.phases = 15}.run(folder.path());
  for (const auto& [key, figure, e] : pairs(*result.rings[0].response)) {
    BOOST_TEST(std::isnan(e.interpolation));
    BOOST_TEST(std::isnan(figure.error));
    BOOST_TEST(of_stiffness(e) > 0);
  }
  BOOST_TEST(app::html(app::key_results(result, {{"", ""}}, "")).find("not known") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(waves_are_exact) {
  const test::TemporaryFolder folder("errors_waves");
  log::set_level(log::Level::quiet);
  const auto result = app::run(app::parse_scene(test::quick_scene(), "s"), {.out = folder.path()});
  for (const auto& [key, figure, e] : pairs(*result.rings[0].response)) {
    BOOST_TEST(of_stiffness(e) == 0);
    BOOST_TEST(e.interpolation == 0);
    BOOST_TEST(figure.error == e.integration);
  }
}

BOOST_AUTO_TEST_CASE(two_planets_feel_the_error_of_their_path) {
  // Two planets, all centres held, constant stiffness: L - 1 is proportional to the stiffness K of a planet's path,
  // 1/K = 1/k_s + 1/k_r + |tangents|^2 / k_bearing. All entries equal: the ripple change lowers every one.
  const test::TemporaryFolder folder("errors_path");
  for (const auto& [sun_error, ring_error] : {std::pair{0.03, 0.0}, {0.0, 0.02}, {0.03, 0.02}}) {
    const TableScene scene{
        .planets = 2, .phases = 8, .sun_error = sun_error, .ring_error = ring_error, .ripple = 0, .held = true};
    const auto result = scene.run(folder.path());
    const auto& set = result.geometry.rings.front().set;
    const double a = set.sun_mesh().working_pressure_angle(), r = set.ring_mesh().working_pressure_angle();
    const double bearing = std::pow(std::cos(a) + std::cos(r), 2) + std::pow(std::sin(a) - std::sin(r), 2);
    const auto path = [&](double sun, double ring) {
      return 1 / (1 / (TableScene::sun * sun) + 1 / (TableScene::ring * ring) + bearing / TableScene::bearing);
    };
    const double nominal = path(1, 1), up_s = 1 + sun_error, up_r = 1 + ring_error;
    const double relative = std::max(path(up_s, 1) - nominal, nominal - path(1 / up_s, 1)) / nominal +
                            std::max(path(1, up_r) - nominal, nominal - path(1, 1 / up_r)) / nominal;
    const auto& response = *result.rings.front().response;
    const auto& quasi_static = response.figures.sun_planet.load_sharing.quasi_static;
    BOOST_TEST(quasi_static.value > 1.002);
    // Forces are solved to about 1e-9, the differences are 1e-3 of L - 1.
    BOOST_TEST(of_stiffness(response.errors.find("sun_planet_load_sharing_quasi_static")->parts) ==
                   relative * (quasi_static.value - 1),
               boost::test_tools::tolerance(1e-4));
    const auto& averaged = response.figures.ring_planet.load_sharing.averaged;
    BOOST_TEST(of_stiffness(response.errors.find("ring_planet_load_sharing_averaged")->parts) ==
                   relative * (averaged.value - 1),
               boost::test_tools::tolerance(1e-3));
  }
}

BOOST_AUTO_TEST_CASE(a_motion_that_does_not_repeat_is_given_up_and_has_errors) {
  // Teeth part under a twentieth of the load: successive windows differ by a third of the load and more, without end.
  auto text = test::replaced(test::small_stage(), "power_kW = 200", "power_kW = 10");
  text = test::replaced(text, "[stage]", "model = \"closed_form\"\naccuracy = 0.03\n[stage]");
  const test::TemporaryFolder folder("chaos");
  log::set_level(log::Level::quiet);
  const auto run = app::run(app::parse_scene(text, "chaos.toml"), {.out = folder.path() / "out"});
  const auto& response = *run.rings.front().response;
  BOOST_TEST(!response.figures.steady);
  BOOST_TEST(response.figures.total_cycles < 20 * 20);  // windows of 20 cycles, at most 40 of them
  const auto& sharing = response.figures.sun_planet.load_sharing.instantaneous;
  BOOST_TEST(std::isfinite(sharing.error));
  BOOST_TEST(sharing.error > 0.01 * sharing.value);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
