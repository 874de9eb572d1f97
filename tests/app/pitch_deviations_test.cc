#include "app/systems/planetary/pitch_deviations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/scene/overrides.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/stage_response.h"
#include "app/systems/planetary/stage_warnings.h"
#include "core/errors.h"
#include "core/log.h"
#include "core/units.h"
#include "dynamics/systems/planetary/planetary_stage.h"
#include "tests/app/scene_refusal.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

/// Pitch deviations of single teeth.
BOOST_AUTO_TEST_SUITE(pitch_deviations)

using namespace annulus;

namespace {

constexpr double turn = 2 * std::numbers::pi, amplitude = 20e-6, direction = 0.7;  // m, rad

/// The small stage by formulas, with more lines of [errors] instead of its own.
std::string stage(const std::string& errors) {
  auto text = test::small_stage();
  const auto begin = text.find("[errors]\n") + 9, end = text.find("[supports]");
  text.replace(begin, end - begin, errors);
  return "model = \"closed_form\"\naccuracy = 0.1\n" + text;
}

std::string list(const std::string& key, const std::vector<double>& places) {
  std::vector<double> pitch;
  for (std::size_t i = 0; i < places.size(); ++i)
    pitch.push_back((places[i] - places[(i + places.size() - 1) % places.size()]) / units::um);
  return fmt::format("{} = [{:.9f}]\n", key, fmt::join(pitch, ", "));
}

/// Places of teeth at these angles on a gear whose centre is off by `amplitude`: their tangential part.
std::vector<double> eccentric(int teeth, double first_angle) {
  std::vector<double> places;
  for (int i = 0; i < teeth; ++i) places.push_back(amplitude * std::sin(direction - first_angle - turn * i / teeth));
  return places;
}

struct Made {
  dynamics::PlanetaryStage stage;
  geometry::PlanetarySet set;
};
Made made(const std::string& text, const test::TemporaryFolder& folder) {
  const auto scene = app::parse_scene(text, "scene.toml");
  const auto geometry = app::make_geometry(scene);
  app::RunOptions options;
  options.out = folder.path();
  options.for_study = true;
  const auto sun = app::mesh_stiffness(scene, geometry, app::sun_mesh_model(scene, geometry), options),
             ring = app::mesh_stiffness(scene, geometry, app::ring_mesh_model(scene, geometry, 0), options);
  return {app::make_stage(scene, geometry, 0, sun, ring), geometry.rings.front().set};
}

/// The largest difference of the error of a mesh to `expected(f t)` over two turns of the slowest gear, over the
/// amplitude.
template <class Expected>
double off(const dynamics::PlanetaryStage& stage, int mesh, Expected expected) {
  const auto system = assemble(stage);
  auto workspace = system.workspace();
  double worst = 0;
  for (double cycles = 0.013; cycles < 144; cycles += 0.271) {
    system.evaluate_excitation(cycles / stage.mesh_frequency(), workspace);
    worst = std::max(worst, std::abs(workspace.error[static_cast<std::size_t>(mesh)] - expected(cycles)));
  }
  return worst / amplitude;
}

}  // namespace

// A gear off its centre has sinusoidal pitch deviations: the tangential part of what its eccentricity does to the
// meshes. A pair keeps its gap while it carries alone, up to 0.2 pitches beside the pitch point: 0.2 x 2 pi / 24 = 5 %
// of the amplitude.
BOOST_AUTO_TEST_CASE(sinusoidal_deviations_are_the_tangential_part_of_an_eccentricity) {
  const test::TemporaryFolder folder("pitch_deviations");
  constexpr double kept = 0.06, cosine = 0.9396926207859084;  // of 20 degrees
  const auto sun = made(stage(list("sun_pitch_deviations_um", eccentric(24, 0))), folder);
  BOOST_TEST(sun.stage.error_period() % 24 == 0);
  for (int n = 0; n < 4; ++n) {
    BOOST_TEST(off(sun.stage, n, [&](double cycles) {
                 return -cosine * amplitude * std::sin(turn * cycles / 24 - sun.set.planet_angle(n) + direction);
               }) < kept);
    BOOST_TEST(off(sun.stage, 4 + n, [](double) { return 0.0; }) < 1e-12);
  }
  // Tooth 1 of a planet is at the sun, on the other side of the planet than its zero.
  const auto planet = made(stage(list("planet_pitch_deviations_um", eccentric(24, std::numbers::pi))), folder);
  const auto half = [&](const geometry::GearPair& pair) {
    const auto& gear = planet.set.planet();
    return gear.tooth_half_angle(gear.base_radius() / std::cos(pair.working_pressure_angle()));
  };
  const double flanks = half(planet.set.sun_mesh()) + half(planet.set.ring_mesh());
  for (int n = 0; n < 4; ++n) {
    const auto angle = [&](double cycles) { return turn * (cycles - planet.set.sun_phase_lag(n)) / 24; };
    BOOST_TEST(off(planet.stage, n,
                   [&](double cycles) { return cosine * amplitude * std::sin(direction - angle(cycles)); }) < kept);
    BOOST_TEST(off(planet.stage, 4 + n, [&](double cycles) {
                 return cosine * amplitude * std::sin(direction - angle(cycles) - flanks);
               }) < kept);
  }
  // Seen from the carrier the ring turns clockwise, and its leading flanks carry.
  const auto ring = made(stage(list("ring_pitch_deviations_um", eccentric(72, 0))), folder);
  for (int n = 0; n < 4; ++n)
    BOOST_TEST(off(ring.stage, 4 + n, [&](double cycles) {
                 const double passed = cycles - ring.set.ring_phase_lag(n) + ring.set.ring_tooth_offset(n);
                 return -cosine * amplitude * std::sin(direction - turn * passed / 72);
               }) < kept / 3);
}

BOOST_AUTO_TEST_CASE(such_teeth_share_the_load_as_an_eccentric_gear_does) {
  const test::TemporaryFolder folder("pitch_sharing");
  log::set_level(log::Level::quiet);
  const auto sharing = [&](const std::string& errors, const std::string& name) {
    const auto result =
        app::run(app::parse_scene(stage(errors), "scene.toml"), {.out = folder.path() / name, .threads = 1});
    return result.rings.front().response->figures.sun_planet.load_sharing;
  };
  // Both parts of an eccentricity make a wave of its amplitude; the tangential one alone is smaller and behind.
  constexpr double cosine = 0.9396926207859084;
  const auto teeth = sharing(list("sun_pitch_deviations_um", eccentric(24, 0)), "teeth"),
             gear = sharing(fmt::format("sun_eccentricity_um = {}\nsun_eccentricity_phase_deg = {}\n",
                                        cosine * amplitude / units::um, direction / units::deg - 20),
                            "gear");
  BOOST_TEST(gear.averaged.value > 1.02);
  BOOST_TEST(teeth.averaged.value - 1 == gear.averaged.value - 1, boost::test_tools::tolerance(0.03));
  BOOST_TEST(teeth.quasi_static.value - 1 == gear.quasi_static.value - 1, boost::test_tools::tolerance(0.03));
}

// Teeth count the other way round in the mirror image, and the pitch before a tooth becomes the one behind it.
BOOST_AUTO_TEST_CASE(the_mirror_image_driven_the_other_way_does_the_same) {
  const test::TemporaryFolder folder("pitch_mirror");
  log::set_level(log::Level::quiet);
  const auto irregular = [](int teeth, double of) {
    std::vector<double> places;
    for (int i = 0; i < teeth; ++i) places.push_back(8e-6 * std::sin(of * i * i) + 5e-6 * std::cos(3 * i + of));
    return places;
  };
  const auto mirrored = [](const std::vector<double>& places) {
    std::vector<double> other;
    for (std::size_t i = 0; i < places.size(); ++i) other.push_back(-places[(places.size() - i) % places.size()]);
    return other;
  };
  const auto sun = irregular(24, 0.37), planet = irregular(24, 1.1), ring = irregular(72, 0.83);
  const auto sharing = [&](bool turned_round) {
    const auto shown = [&](const std::vector<double>& places) { return turned_round ? mirrored(places) : places; };
    auto text = stage(list("sun_pitch_deviations_um", shown(sun)) + list("planet_pitch_deviations_um", shown(planet)) +
                      list("ring_pitch_deviations_um", shown(ring)));
    if (turned_round) text = test::replaced(text, "sun_speed_rpm = 1500", "sun_speed_rpm = -1500");
    const auto result = app::run(app::parse_scene(text, "scene.toml"),
                                 {.out = folder.path() / (turned_round ? "mirrored" : "as_drawn"), .threads = 1});
    return result.rings.front().response->figures;
  };
  const auto one = sharing(false), other = sharing(true);
  BOOST_TEST(one.sun_planet.load_sharing.averaged.value > 1.05);
  for (const auto& [a, b] : {std::pair{&one.sun_planet, &other.sun_planet}, {&one.ring_planet, &other.ring_planet}}) {
    // The steps of the time integration follow rounding.
    BOOST_TEST(a->load_sharing.averaged.value == b->load_sharing.averaged.value, boost::test_tools::tolerance(1e-4));
    BOOST_TEST(a->load_sharing.quasi_static.value == b->load_sharing.quasi_static.value,
               boost::test_tools::tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(errors_are_gaps_weighed_by_load_shares) {
  // Two pairs at phase 0, one at phase 0.5.
  PairShares shares{2, 0, {{0.7, 0.3}, {1, 0}}};
  const auto curve = app::error_of_gaps({0, 0, 5e-6, 0}, shares);
  BOOST_TEST(curve.period() == 4);
  const double expected[] = {0, 0, 0.3 * 5e-6, 0, 0.7 * 5e-6, 5e-6, 0, 0};
  for (int i = 0; i < 8; ++i) BOOST_TEST(std::abs(curve(0.5 * i) - expected[i]) < 1e-18);
  // Linear springs with these gaps: k (d - g) of each pair, all in contact. The deflection by the load stays.
  const double k[] = {0.7e9, 0.3e9}, g[] = {3e-6, 8e-6}, load = 1e4;
  const double deflection = (load + k[0] * g[0] + k[1] * g[1]) / (k[0] + k[1]);
  const auto of_both = app::error_of_gaps({g[0], g[1]}, {1, 0, {{0.7, 0.3}}});
  BOOST_TEST(of_both(0) == deflection - load / 1e9, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(lists_of_teeth_are_not_lists_of_planets) {
  const auto text = stage(list("sun_pitch_deviations_um", eccentric(24, 0)));
  const auto scene = app::parse_scene(text, "scene.toml");
  const auto paths = app::expand_planets(scene, "errors.sun_pitch_deviations_um[*]");
  BOOST_TEST(paths.size() == 24U);
  BOOST_TEST((app::find_input(scene, paths.back()).index == 23U));
  BOOST_CHECK_THROW((void)app::find_input(scene, "errors.ring_pitch_deviations_um[1]"), InputError);
  // Assemblies are drawn without them, and a warning says so.
  const auto drawn = app::parse_scene(text + "[tolerances]\nplanet_pin_position_um = 20\n", "scene.toml");
  const auto warnings = app::stage_scene_warnings(drawn, app::make_geometry(drawn));
  BOOST_TEST(std::any_of(warnings.begin(), warnings.end(), [](const auto& w) { return w.key == "pitch_deviations"; }));
}

BOOST_AUTO_TEST_CASE(lists_that_do_not_fit_are_refused) {
  const auto says = [](const std::string& text, const std::string& words) {
    const auto message = test::scene_refusal(text);
    BOOST_TEST(message.find(words) != std::string::npos, message);
  };
  const std::string zeros = fmt::format("{}", fmt::join(std::vector<double>(23, 0), ", "));
  says(stage("sun_pitch_deviations_um = [" + zeros + "]\n"), "23 values for 24 teeth");
  says(stage("sun_pitch_deviations_um = [" + zeros + ", 9]\n"), "add up to 9 µm");
  says(stage("planet_pitch_deviations_um = [" + zeros + "]\n"), "for one planet that stands for all (24)");
}

BOOST_AUTO_TEST_CASE(deviations_are_drawn_within_a_flank_tolerance_class) {
  const auto scene =
      app::parse_scene(stage("sun_pitch_class = 7\nplanet_pitch_class = 6\nring_pitch_class = 8\n"), "scene.toml");
  const auto& e = planetary(scene).errors;
  const auto largest = [](const std::vector<double>& list) {
    double most = 0;
    for (const double value : list) most = std::max(most, std::abs(value));
    return most;
  };
  // [ISO1328-1]: 24 teeth of 4 mm, d = 96 mm: 6.696 um in class 5; 72 teeth, 288 mm: 6.888 um. To whole ones and
  // halves.
  BOOST_TEST(e.sun_pitch.size() == 24U);
  BOOST_TEST(largest(e.sun_pitch) == 13e-6, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(e.planet_pitch.size() == 96U);
  BOOST_TEST(largest(e.planet_pitch) == 9.5e-6, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(largest(e.ring_pitch) == 19e-6, boost::test_tools::tolerance(1e-6));
  // Planets have draws of their own, and results state them.
  BOOST_TEST(e.planet_pitch[0] != e.planet_pitch[24]);
  BOOST_REQUIRE(scene.find("errors.sun_pitch_deviations_um") != nullptr);
  BOOST_CHECK(scene.find("errors.sun_pitch_deviations_um")->origin == app::Origin::derived);
  const auto other = app::parse_scene(stage("sun_pitch_class = 7\npitch_seed = 2\n"), "scene.toml");
  BOOST_TEST(planetary(other).errors.sun_pitch[0] != e.sun_pitch[0]);
  const auto both =
      test::scene_refusal(stage("sun_pitch_class = 7\n" + list("sun_pitch_deviations_um", eccentric(24, 0))));
  BOOST_TEST(both.find("the list states the deviations") != std::string::npos, both);
  const auto tiny =
      test::scene_refusal(test::replaced(stage("sun_pitch_class = 7\n"), "module_mm = 4\n", "module_mm = 0.4\n"));
  BOOST_TEST(tiny.find("errors.sun_pitch_class = 7: ISO 1328-1 has no flank tolerances") != std::string::npos, tiny);
}

BOOST_AUTO_TEST_SUITE_END()
