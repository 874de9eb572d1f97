#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "core/csv.h"
#include "core/files.h"
#include "core/json.h"
#include "core/units.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/app/statics_scenes.h"
#include "tests/temporary_folder.h"
#include "tests/verification_record.h"

/// annulus run of stages whose bodies have bearings in their places.
BOOST_AUTO_TEST_SUITE(space_dynamics)

using namespace annulus;
using namespace annulus::test::statics;

/// The helical stage with masses, [dynamics] and a pin beside its place; the sun is centred by its spline.
std::string moving_stage(const std::string& more) {
  auto scene = helical_stage();
  scene = test::replaced(scene, "mass_kg = 180\n", "mass_kg = 180\ninertia_kg_m2 = 1\n");
  scene = test::replaced(scene, "mass_kg = 110\n", "mass_kg = 110\ninertia_kg_m2 = 3\n");
  scene = test::replaced(scene, "mass_kg = 1500\n", "mass_kg = 1500\ninertia_kg_m2 = 45\n");
  scene = test::replaced(scene, "mass_kg = 509\n", "mass_kg = 509\ninertia_kg_m2 = 153\n");
  return scene +
         "[errors]\nplanet_pin_position_error_um = [0, 60, 0]\nplanet_pin_position_error_phase_deg = [0, 210, 0]\n"
         "[supports]\nsun_N_per_m = \"floating\"\nring_N_per_m = \"rigid\"\n[dynamics]\nhalf_backlash_um = "
         "300\nmesh_damping_ratio = "
         "0.07\nsupport_damping_ratio = 0.03\n" +
         more;
}

std::string bearings() {
  return bearing("upwind row", "planet", "at_mm = -60\nradial_N_per_m = 2e9\naxial_N_per_m = 1e9\n") +
         bearing("downwind row", "planet", "at_mm = 60\nradial_N_per_m = 2e9\n") +
         bearing("upwind", "carrier", "at_mm = -300\nradial_N_per_m = 3e9\naxial_N_per_m = 1e9\n") +
         bearing("downwind", "carrier", "at_mm = 300\nradial_N_per_m = 3e9\n") +
         bearing("spline", "sun", "at_mm = 700\nradial_N_per_m = 2e8\naxial_N_per_m = 3e8\ntilt_Nm_per_rad = 1e7\n");
}

const std::string inertias = "[tilt_inertia]\nsun_kg_m2 = 2\nplanet_kg_m2 = 2\nring_kg_m2 = 90\ncarrier_kg_m2 = 60\n";

Json run(const test::TemporaryFolder& folder, const std::string& scene, const std::string& options = "") {
  write_file(folder.path() / "scene.toml", scene);
  const auto outcome = test::run_program(folder.path(), "run scene.toml --out out --quiet " + options);
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  return Json::parse(read_file(folder.path() / "out/summary.json"));
}

bool warns(const Json& summary, const std::string& code) {
  for (const auto& warning : summary.at("warnings"))
    if (warning.at("key") == code) return true;
  return false;
}

void compare_sharing(test::Verification& record, const std::string& title, const Json& summary, const Json& statics,
                     double tolerance, const std::string& origin) {
  for (const std::string mesh : {"sun_planet", "ring_planet"})
    record.close(title, "",
                 summary.at("rings").at("held").at("load_sharing").at(mesh).at("averaged").at("value").get<double>(),
                 result(statics, mesh + "_static_load_sharing"), tolerance, origin);
}

// At a low speed the motion is the equilibrium: load sharing and the place of the forces are those of annulus statics,
// which solves for them with another formulation.
BOOST_AUTO_TEST_CASE(slow_stage_shares_the_load_as_in_the_statics) {
  test::Verification record("annulus run of a stage in space", "annulus statics");
  const test::TemporaryFolder folder("space_dynamics_1");
  const auto scene = moving_stage(bearings() + inertias);
  const auto summary = run(folder, scene);
  const auto statics = solved(folder, scene);
  compare_sharing(record, "load sharing of a stage with a pin beside its place", summary, statics, 1e-3, "inertia");
  for (const std::string mesh : {"sun_planet", "ring_planet"})
    record.close("K_Hβ of a mesh cycle", "", face_load_factor_in_motion(summary, mesh),
                 result(statics, mesh + "_static_face_load_factor"), 2e-3, "places on the face, inertia");
  const auto forces = table(folder, "mesh_forces.csv");
  for (const std::string mesh : {"sun_planet1", "sun_planet2", "ring_planet3"})
    record.near("place of the mesh force along the face", "m",
                summary.at("rings").at("held").at("places_of_mesh_forces").at(mesh).at("mean_m").get<double>(),
                forces.rows[0][forces.column(mesh + "_load_at_mm")] * 1e-3, 2e-4, "places on the face, inertia");
  // An axial bearing of a planet carries nothing: both meshes push along the axis alike.
  const auto& bearing = summary.at("rings").at("held").at("bearings_in_space").at("planet1_upwind_row");
  BOOST_TEST(std::abs(bearing.at("axial_mean_N").get<double>()) < 1e-3 * bearing.at("radial_mean_N").get<double>());
  int kinds = 0;
  for (const auto& mode : summary.at("rings").at("held").at("natural_frequencies_Hz"))
    kinds += mode.at("kind") == "translational-tilting" ? 1 : 0;
  BOOST_TEST(kinds == 20);  // the ring is held
  BOOST_TEST(!warns(summary, "tilt_inertia_assumed"));
  BOOST_TEST(!warns(summary, "bearings_linear"));
  const auto csv = Csv::read(folder.path() / "out/held/dynamics/bearings_in_space.csv");
  BOOST_TEST(csv.rows[0][csv.column("planet1_upwind_row_radial_max_N")] > 1e5);
  BOOST_TEST(read_file(folder.path() / "out/report.html").find("planet1_upwind_row") != std::string::npos);
  const auto loads = Csv::read(folder.path() / "out/held/dynamics/face_loads.csv");
  double sum = 0;  // trapezoidal rule over equal stretches
  for (std::size_t i = 0; i + 1 < loads.rows.size(); ++i)
    sum += (loads.rows[i][1] + loads.rows[i + 1][1]) / 2 * (loads.rows[i + 1][0] - loads.rows[i][0]);
  BOOST_TEST(loads.columns[1] == "sun_planet1_mean_N_per_m");
  const double base_helix = std::asin(std::sin(7.5 * units::deg) * std::cos(20 * units::deg));
  record.close("integral of the load along the face", "N", sum,
               forces.rows[0][forces.column("sun_planet1_force_N")] / std::cos(base_helix), 2e-3,
               "places on the face, inertia");
}

// The carrier turns past weight and a rotor's moment: load sharing over its revolution is that of the statics.
BOOST_AUTO_TEST_CASE(slow_stage_turns_past_its_loads_as_in_the_statics) {
  test::Verification record("annulus run of a stage under loads in the housing", "annulus statics");
  const test::TemporaryFolder folder("space_dynamics_3");
  auto scene = moving_stage(bearings() + inertias +
                            "[gravity]\ndirection_deg = 270\n[[load]]\nname = \"rotor\"\nbody = \"carrier\"\n"
                            "moment_Nm = [50e3, 100e3, 0]\nforce_N = [0, -40e3, 0]\n");
  scene = test::replaced(scene, "sun_speed_rpm = 100", "sun_speed_rpm = 10");
  const auto summary = run(folder, scene);
  const auto statics = solved(folder, scene);
  compare_sharing(record, "load sharing over a revolution of the carrier", summary, statics, 2e-3,
                  "inertia; positions of the statics");
  // Without them it is another.
  auto unloaded = scene.substr(0, scene.find("[gravity]"));
  const auto without = solved(folder, unloaded);
  BOOST_TEST(result(statics, "sun_planet_static_load_sharing") - result(without, "sun_planet_static_load_sharing") >
             5e-3);
}

BOOST_AUTO_TEST_CASE(what_is_assumed_is_said_and_bearings_can_be_studied) {
  const test::TemporaryFolder folder("space_dynamics_2");
  auto scene = moving_stage(in_space("[50e3, 100e3, 0]"));
  scene +=
      "[[sweep]]\ninput = \"bearing.spline.tilt_Nm_per_rad\"\nfrom = 1e5\nto = 1e8\ncount = 2\nscale = "
      "\"logarithmic\"\n";
  const auto summary = run(folder, scene);
  BOOST_TEST(warns(summary, "tilt_inertia_assumed"));
  BOOST_TEST(!warns(summary, "bearings_linear"));
  BOOST_TEST(warns(summary, "bearing_laws"));  // the carrier wanders in its clearance
  BOOST_TEST(!warns(summary, "supports_left_out"));
  BOOST_TEST(!warns(summary, "mass_in_middle"));  // planets have their weight there
  // A bearing in one direction alone has its mean over a turn.
  const auto checked = [&](const std::string& text) {
    write_file(folder.path() / "checked.toml", text);
    const auto outcome = test::run_program(folder.path(), "check checked.toml --json");
    BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
    return Json::parse(outcome.out);
  };
  const auto held = moving_stage(bearings());
  BOOST_TEST(!warns(checked(held), "bearings_averaged"));
  BOOST_TEST(warns(checked(held + bearing("guide", "carrier", "x_N_per_m = 1e9\n")), "bearings_averaged"));
  BOOST_TEST(
      !warns(checked(held + bearing("guide", "sun", "on = \"carrier\"\nx_N_per_m = 1e9\n")), "bearings_averaged"));
  // A soft guide of 1 N/µm whose table ends below, and above, what it bears.
  const auto guided = [&](const std::string& end) {
    return run(folder,
               held + bearing("guide", "sun",
                              "radial_displacement_um = [0, " + end + "]\nradial_force_N = [0, " + end + "]\n"));
  };
  BOOST_TEST(warns(guided("1"), "bearing_beyond_table"));
  BOOST_TEST(!warns(guided("1000"), "bearing_beyond_table"));
  // Without an axial bearing the carrier screws itself along the axis.
  const auto loose = test::replaced(moving_stage(bearings()), "axial_N_per_m = 1e9\n[[bearing]]\nname = \"downwind\"",
                                    "[[bearing]]\nname = \"downwind\"");
  write_file(folder.path() / "loose.toml", loose);
  // Before meshes are solved, and without [dynamics].
  auto at_rest = loose;
  at_rest.erase(at_rest.find("[dynamics]"), at_rest.find("[[bearing]]") - at_rest.find("[dynamics]"));
  write_file(folder.path() / "at_rest.toml", at_rest);
  for (const auto* command : {"check loose.toml", "check at_rest.toml", "run loose.toml --out loose --quiet"}) {
    const auto refused = test::run_program(folder.path(), command);
    BOOST_TEST(refused.status == 2, command);
    BOOST_TEST(refused.err.find("nothing resists a motion of ") != std::string::npos, refused.err);
  }
  // Bodies that are held twice: how both share the load is not known.
  write_file(folder.path() / "twice.toml", held +
                                               bearing("second", "carrier", "at_mm = 0\naxial_N_per_m = \"rigid\"\n") +
                                               bearing("third", "carrier", "at_mm = 10\naxial_N_per_m = \"rigid\"\n"));
  const auto twice = test::run_program(folder.path(), "check twice.toml");
  BOOST_TEST(twice.status == 2);
  BOOST_TEST(twice.err.find("is already held rigidly by other supports") != std::string::npos, twice.err);
}

BOOST_AUTO_TEST_SUITE_END()
