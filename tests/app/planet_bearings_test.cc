#include <Eigen/Dense>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "app/systems/planetary/carrier_pins.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/planetary/stage_response.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/planetary/stage_warnings.h"
#include "core/csv.h"
#include "core/files.h"
#include "core/json.h"
#include "core/radial_bearing.h"
#include "core/units.h"
#include "tests/app/run_program.h"
#include "tests/app/scene_refusal.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"
#include "tests/verification_record.h"

/// Clearance of planet bearings and the pins that carry them.
BOOST_AUTO_TEST_SUITE(planet_bearings)

using namespace annulus;

namespace {

std::string with_bearing(const std::string& keys) {
  return test::replaced(test::quick_scene(), "planet_N_per_m = 1e9\n", keys);
}

app::Scene scene_of(const std::string& keys) { return app::parse_scene(with_bearing(keys), "scene.toml"); }

dynamics::PlanetaryStage stage_of(const std::string& keys) {
  const auto scene = scene_of(keys);
  const auto geometry = app::make_geometry(scene);
  const app::MeshResult none{.model = app::sun_mesh_model(scene, geometry), .table = {}, .tabulated = false};
  return app::make_stage(scene, geometry, 0, none, none);
}

std::string pin(const std::string& mounting, double diameter_mm, double length_mm) {
  return "planet_pin = \"" + mounting + "\"\nplanet_pin_diameter_mm = " + std::to_string(diameter_mm) +
         "\nplanet_pin_length_mm = " + std::to_string(length_mm) + "\n";
}

/// Deflection and slope under a unit force, by integrating the beam's equations from the clamped end: slope' = M / E I,
/// deflection' = slope + V / (kappa G A). `moment(x)`: N m of a unit force; V = 1.
struct Deflected {
  double deflection = 0, slope = 0;
};
template <class Moment>
Deflected integrate(double diameter, double length, const Moment& moment) {
  const double E = 206e9, nu = 0.3, inertia = std::numbers::pi * std::pow(diameter, 4) / 64,
               area = std::numbers::pi * diameter * diameter / 4;
  const double shear = 6 * (1 + nu) / (7 + 6 * nu) * E / (2 * (1 + nu)) * area;
  Deflected at;
  constexpr int steps = 20000;
  const double h = length / steps;
  for (int i = 0; i < steps; ++i) {
    const double slope = at.slope + moment((i + 0.5) * h) / (E * inertia) * h / 2;
    at.deflection += h * (slope + 1 / shear);
    at.slope += h * moment((i + 0.5) * h) / (E * inertia);
  }
  return at;
}

}  // namespace

// Midpoint rule with 20000 steps: (1/20000)^2.
BOOST_AUTO_TEST_CASE(pins_bend_as_beams) {
  test::Verification record("Stiffness of planet pins", "the beam's differential equations, integrated");
  const double d = 80e-3, length = 160e-3;
  const auto compliance = [&](const char* mounting) {
    return 1 / app::pin_stiffness(scene_of("planet_N_per_m = 1e9\n" + pin(mounting, 80, 160)));
  };
  const auto cantilever = integrate(d, length, [&](double x) { return length - x; });
  record.close("cantilever", "m/N", compliance("cantilever"), cantilever.deflection, 1e-7);
  // A unit force over the middle of the pin: on its end it acts with a moment of -L/2.
  const auto flexpin = integrate(d, length, [&](double x) { return length / 2 - x; });
  record.close("flexpin", "m/N", compliance("flexpin"), flexpin.deflection, 1e-7);
  record.near("slope at the end of a flexpin", "rad/N", flexpin.slope, 0, 1e-16);
  // By symmetry each half takes half of the force, and the middle does not turn.
  const auto half = integrate(d, length / 2, [&](double x) { return length / 4 - x; });
  record.near("slope in the middle", "rad/N", half.slope, 0, 1e-16);
  record.close("between walls", "m/N", compliance("between_walls"), half.deflection / 2, 1e-7);
  const auto scene = scene_of("planet_N_per_m = 1e9\n" + pin("cantilever", 80, 160));
  record.close("tilt of a cantilever", "rad/N", app::pin_tilt(scene, 1), cantilever.slope, 1e-7);
  BOOST_TEST(app::pin_stiffness(scene_of("planet_N_per_m = 1e9\n")) == app::rigid);
}

BOOST_AUTO_TEST_CASE(keys_reach_the_model) {
  const auto close = [](double a, double b) { return std::abs(a - b) <= 1e-12 * b; };
  const auto plain = stage_of("planet_N_per_m = 8e8\n").planet_bearing(1);
  BOOST_TEST((plain.radial == 8e8 && plain.play == 0 && plain.pin == dynamics::rigid));
  const auto loose = stage_of("planet_N_per_m = 8e8\nplanet_clearance_um = 30\n").planet_bearing(1);
  BOOST_TEST((loose.radial == 8e8 && loose.tangential == 8e8 && close(loose.play, 15e-6)));
  const auto keys = "planet_N_per_m = 8e8\n" + pin("flexpin", 70, 150);
  const double stiffness = app::pin_stiffness(scene_of(keys));
  // Without clearance the pin is a part of the bearing, with it a seat in series.
  const auto bent = stage_of(keys).planet_bearing(0);
  BOOST_TEST((close(bent.radial, 1 / (1 / 8e8 + 1 / stiffness)) && bent.pin == dynamics::rigid));
  const auto both = stage_of(keys + "planet_clearance_um = 30\n").planet_bearing(0);
  BOOST_TEST((both.radial == 8e8 && close(both.pin, stiffness)));
  // A pin alone, and beside bearings of their own.
  BOOST_TEST(close(stage_of(pin("flexpin", 70, 150)).planet_bearing(4).tangential, stiffness));
  const auto own = stage_of("planet_radial_N_per_m = [1e9, 2e9, 3e8, inf, 5e8]\n" + pin("flexpin", 70, 150));
  BOOST_TEST(close(own.planet_bearing(3).radial, stiffness));
  BOOST_TEST(close(own.planet_bearing(1).radial, 1 / (1 / 2e9 + 1 / stiffness)));
  // However stiff, a bearing with clearance keeps its degree of freedom.
  BOOST_TEST(std::isfinite(stage_of("planet_N_per_m = 1e15\nplanet_clearance_um = 3\n").planet_bearing(0).radial));
}

BOOST_AUTO_TEST_CASE(contradictions_are_refused) {
  const auto refused = [](const std::string& keys, const std::string& words) {
    const auto text = test::scene_refusal(with_bearing(keys));
    BOOST_TEST(text.find(words) != std::string::npos, "\"" << text << "\" does not say \"" << words << "\"");
  };
  refused("planet_clearance_um = 20\n", "supports.planet_clearance_um");
  refused("planet_N_per_m = \"rigid\"\nplanet_clearance_um = 20\n", "needs a bearing that gives way");
  refused("planet_N_per_m = 1e9\nplanet_clearance_um = -1\n", "0 <= value <= 1000");
  refused("planet_N_per_m = 1e9\nplanet_clearance_um = 20\nplanet_radial_N_per_m = [1e9, 1e9, 1e9, 1e9, 1e9]\n",
          "one stiffness in all directions");
  refused("planet_N_per_m = 1e9\nplanet_pin = \"cantilever\"\nplanet_pin_length_mm = 50\n", "planet_pin_diameter_mm");
  refused("planet_N_per_m = 1e9\nplanet_pin_diameter_mm = 50\n", "planet_pin_diameter_mm");
  refused("planet_N_per_m = 1e9\nplanet_pin = \"flexible\"\n", "flexpin");
  const auto impossible = [](const std::string& keys, const std::string& words) {
    const auto scene = scene_of(keys);
    BOOST_CHECK_EXCEPTION(app::check_planetary_geometry(scene, app::make_geometry(scene)), InputError,
                          [&](const InputError& error) {
                            BOOST_TEST_MESSAGE(error.what());
                            return std::string(error.what()).find(words) != std::string::npos;
                          });
  };
  impossible(pin("cantilever", 8, 200), "supports.planet_pin_diameter_mm = 8: a pin of this diameter");
  impossible("planet_N_per_m = 1e9\nplanet_clearance_um = 40\n" + pin("cantilever", 8, 200), "use a thicker");
  impossible("planet_N_per_m = 1e14\nplanet_clearance_um = 40\n", "carry over");
}

BOOST_AUTO_TEST_CASE(what_a_plane_model_leaves_out_is_said) {
  const auto warnings = [](const std::string& keys) {
    const auto scene = scene_of(keys);
    std::string text;
    for (const auto& warning : app::stage_scene_warnings(scene, app::make_geometry(scene))) text += warning.text + "\n";
    return text;
  };
  const auto tilted = warnings("planet_N_per_m = 1e9\n" + pin("cantilever", 80, 120));
  BOOST_TEST(tilted.find("cantilevered planet pins tilt") != std::string::npos, tilted);
  BOOST_TEST(warnings("planet_N_per_m = 1e9\n" + pin("flexpin", 80, 120)).find("tilt") == std::string::npos);
  // A scene that describes its pins does not leave the planets' bearings out.
  const auto left_out = [&](const std::string& keys) {
    return warnings(keys).find("supports.planet_N_per_m") != std::string::npos;
  };
  BOOST_TEST(left_out(""));
  BOOST_TEST(!left_out(pin("flexpin", 80, 120)));
}

// A run states load zones, and they are those of its pin forces.
BOOST_AUTO_TEST_CASE(a_run_with_clearance) {
  const test::TemporaryFolder folder("planet_bearings");
  write_file(folder.path() / "scene.toml", with_bearing("planet_N_per_m = 1e9\nplanet_clearance_um = 40\n"));
  const auto outcome = test::run_program(folder.path(), "run scene.toml --out out");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  const auto summary = Json::parse(read_file(folder.path() / "out" / "summary.json"));
  const auto& forces = summary["rings"]["held"]["bearing_forces"];
  const RadialBearing law(1e9, 20e-6);
  const auto csv = Csv::read(folder.path() / "out" / "held" / "dynamics" / "bearing_forces.csv");
  double smallest = 360;
  for (int n = 1; n <= 5; ++n) {
    const auto planet = "planet" + std::to_string(n);
    const auto zone = csv.column(planet + "_load_zone_min_deg"), force = csv.column(planet + "_resultant_min_N");
    for (const auto& row : csv.rows) {
      BOOST_TEST(std::abs(row[zone] - law.load_zone(row[force]) / units::deg) <= 1e-3);
      smallest = std::min(smallest, row[zone]);
    }
  }
  BOOST_TEST(std::abs(forces["load_zone_min_deg"].get<double>() - smallest) <= 1e-3);
  BOOST_TEST((smallest > 0 && smallest < 180));
  // All bearings of planets are one group of the strain energy.
  const auto modes = read_file(folder.path() / "out" / "held" / "dynamics" / "modes.csv");
  BOOST_TEST(modes.find(",strain_planet_bearing,") != std::string::npos, modes.substr(0, 600));
  BOOST_TEST(modes.find("strain_planet_bearing_") == std::string::npos);
}

namespace {

/// The smallest stage with thin planets on rollers.
std::string thin_planets(const std::string& bearing = "planet_N_per_m = 1e9, planet_clearance_um = 30") {
  auto text = test::replaced(read_file(ANNULUS_SOURCE_DIR "/data/scenes/minimal.toml"), "bore_diameter_mm = 45",
                             "bore_diameter_mm = 70, bore = \"rollers\"");
  return test::replaced(text, "planet_N_per_m = 1e9", bearing);
}

}  // namespace

BOOST_AUTO_TEST_CASE(planets_on_rollers_reach_both_meshes) {
  const auto scene = app::parse_scene(thin_planets(), "scene.toml");
  const auto geometry = app::make_geometry(scene);
  const auto sun = app::sun_mesh_model(scene, geometry), ring = app::ring_mesh_model(scene, geometry, 0);
  for (const auto* model : {&sun, &ring}) {
    BOOST_TEST_REQUIRE(model->problem->planet_rollers.has_value());
    const auto& rollers = *model->problem->planet_rollers;
    BOOST_TEST((rollers.stiffness == 1e9 && std::abs(rollers.play - 15e-6) < 1e-15));
    BOOST_TEST(rollers.partner.internal() != model->problem->pair.internal());
    BOOST_TEST((model->fidelity == "plane"));
  }
  // All that they stand on belongs to the identity of a mesh.
  const auto other = [&](const std::string& bearing) {
    const auto changed = app::parse_scene(thin_planets(bearing), "scene.toml");
    return app::sun_mesh_model(changed, app::make_geometry(changed)).id();
  };
  BOOST_TEST(other("planet_N_per_m = 2e9, planet_clearance_um = 30") != sun.id());
  BOOST_TEST(other("planet_N_per_m = 1e9") != sun.id());
  BOOST_TEST(other("planet_N_per_m = 1e9, planet_clearance_um = 30") == sun.id());
}

BOOST_AUTO_TEST_CASE(rollers_that_carry_too_little_of_the_bore) {
  const auto light = test::replaced(thin_planets("planet_N_per_m = 1e9, planet_clearance_um = 400"), "power_kW = 200",
                                    "power_kW = 10");
  const auto scene = app::parse_scene(light, "scene.toml");
  BOOST_CHECK_EXCEPTION(
      app::check_planetary_geometry(scene, app::make_geometry(scene)), InputError,
      [](const InputError& error) { return std::string(error.what()).find("planet.bore") != std::string::npos; });
}

BOOST_AUTO_TEST_CASE(rollers_that_are_not_modelled_are_refused) {
  const auto refused = [](const std::string& text, const std::string& words) {
    const auto message = test::scene_refusal(text);
    BOOST_TEST(message.find(words) != std::string::npos, "\"" << message << "\" does not say \"" << words << "\"");
  };
  refused(thin_planets("planet_N_per_m = \"rigid\""), "needs a bearing that gives way");
  refused(thin_planets("planet_radial_N_per_m = [1e9, 1e9, 1e9, 1e9]"), "planet.bore");
  refused(test::replaced(thin_planets(), "module_mm = 4\n", "module_mm = 4\nhelix_angle_deg = 5\n"),
          "not modelled for helical teeth");
  refused("model = \"resolved\"\n" + thin_planets(), "needs a whole planet");
  refused("model = \"closed_form\"\n" + thin_planets(), "needs a whole planet");
}

BOOST_AUTO_TEST_CASE(a_prescribed_mesh_leaves_out_the_coupling_of_a_planet) {
  const auto warned = [](const std::string& text) {
    const auto scene = app::parse_scene(text, "scene.toml");
    const auto list = app::stage_scene_warnings(scene, app::make_geometry(scene));
    return std::any_of(list.begin(), list.end(), [](const auto& w) { return w.key == "planet_coupling_left_out"; });
  };
  BOOST_TEST(!warned(thin_planets()));
  BOOST_TEST(warned(thin_planets() + "\n[mesh.sun_planet]\nstiffness = \"constant\"\nmean_N_per_m = 1e9\n"));
}

// The load of the rollers adds up to the forces of both meshes, whichever mesh it was solved in; that the rim spreads
// it is what thin rims are known for. Both solutions have the same loads on the planet but where the contact of the own
// mesh is exact and that of the other one is not.
BOOST_AUTO_TEST_CASE(a_run_with_planets_on_rollers) {
  const test::TemporaryFolder folder("planets_on_rollers");
  write_file(folder.path() / "scene.toml", thin_planets());
  const auto outcome = test::run_program(folder.path(), "run scene.toml --out out");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  test::Verification record("Rollers of a thin planet", "the same planet solved in its other mesh; statics");
  const auto summary = Json::parse(read_file(folder.path() / "out" / "summary.json"));
  const auto& ring = summary["rings"]["ring"];
  const double nominal = summary["operating_point"]["mean_mesh_force_N"];
  const double both = 2 * nominal * std::cos(20 * units::deg);
  for (const auto& file :
       {folder.path() / "out" / "rollers_sun_planet.csv", folder.path() / "out" / "ring" / "rollers_ring_planet.csv"}) {
    const auto csv = Csv::read(file);
    const auto angle = csv.column("angle_deg"), load = csv.column("load_N_per_deg"), phase = csv.column("mesh_phase");
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double patches = 0;
    for (const auto& row : csv.rows)
      if (row[phase] == 0) {
        sum += row[load] * Eigen::Vector2d(std::cos(row[angle] * units::deg), std::sin(row[angle] * units::deg));
        patches += 1;
      }
    sum *= 360 / patches;
    record.close("sum of the loads across the planet", "N", -sum.y(), both, 3e-3,
                 "half-width of the contact over the base radius");
    BOOST_TEST(std::abs(sum.x()) <= 5e-3 * both);
  }
  const auto of_mesh = [&](const char* mesh, const char* what) {
    return ring["planet_rollers"][mesh][what].get<double>();
  };
  record.close("largest load, sun against ring mesh", "N/degree", of_mesh("sun_planet", "largest_N_per_deg"),
               of_mesh("ring_planet", "largest_N_per_deg"), 0.02, "the other mesh's load at places of a flank");
  BOOST_TEST(of_mesh("sun_planet", "load_zone_deg") > of_mesh("sun_planet", "load_zone_of_round_rim_deg"));
  BOOST_TEST(of_mesh("sun_planet", "largest_over_round_rim") < 1);
  const auto deflection = "deflection_by_other_mesh_m_per_N";
  record.close("deflection by the other mesh, sun against ring mesh", "m/N", of_mesh("sun_planet", deflection),
               of_mesh("ring_planet", deflection), 0.02, "the other mesh's load at places of a flank");
  const auto modes = read_file(folder.path() / "out" / "ring" / "dynamics" / "modes.csv");
  BOOST_TEST(modes.find(",strain_planet_body") != std::string::npos, modes.substr(0, 600));
  const auto page = read_file(folder.path() / "out" / "report.html");
  BOOST_TEST(page.find("id=\"rollers\"") != std::string::npos);
  const auto stress = read_file(folder.path() / "out" / "stress_sun_planet.csv");
  BOOST_TEST(stress.find("planet rim") != std::string::npos);
}

// The matrix of a pin in space contains the stiffness and the tilt of the plane, and its wall stands on the side of -z.
BOOST_AUTO_TEST_CASE(pins_in_space_bend_as_in_the_plane) {
  for (const std::string mounting : {"between_walls", "cantilever", "flexpin"}) {
    const auto scene = scene_of("planet_N_per_m = 1e9\n" + pin(mounting, 60, 120));
    const auto stiffness = app::pins_in_space(scene, {0.3}, 0.1);
    BOOST_TEST_REQUIRE(stiffness.has_value());
    const Eigen::Matrix<double, 5, 5> compliance = stiffness->inverse();
    const auto near = boost::test_tools::tolerance(1e-9);
    BOOST_TEST(compliance(0, 0) == 1 / app::pin_stiffness(scene), near);
    BOOST_TEST(compliance(1, 1) == 1 / app::pin_stiffness(scene), near);
    BOOST_TEST(std::abs(compliance(4, 0) - app::pin_tilt(scene, 1)) <= 1e-9 * compliance(4, 4));
    BOOST_TEST(std::abs(compliance(3, 1) + app::pin_tilt(scene, 1)) <= 1e-9 * compliance(4, 4));
  }
  BOOST_TEST(!app::pins_in_space(scene_of("planet_N_per_m = 1e9\n"), {0.3}, 0.1).has_value());
  // Under a moment in the middle each half of a clamped pin bends as a beam whose end turns and does not shift: in the
  // limit of a slender one 2 x 4 E I / (L / 2).
  const auto slender = scene_of("planet_N_per_m = 1e9\n" + pin("between_walls", 20, 400));
  const double bending = 206e9 * std::numbers::pi * std::pow(0.02, 4) / 64;
  BOOST_TEST((*app::pins_in_space(slender, {0.3}, 0.1))(3, 3) == 16 * bending / 0.4,
             boost::test_tools::tolerance(0.02));
}

BOOST_AUTO_TEST_SUITE_END()
