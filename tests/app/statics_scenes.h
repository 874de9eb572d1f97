#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <string>

#include "core/csv.h"
#include "core/files.h"
#include "core/json.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

/// Stages in space that tests of annulus statics share, and their results.
namespace annulus::test::statics {

/// Three helical planets of prescribed stiffness, everything else to be added. The sun drives.
inline std::string helical_stage(const std::string& helix = "7.5", const std::string& speed = "100") {
  return R"(title = "Helical"
[stage]
kind = "planetary"
planets = 3
module_mm = 10
pressure_angle_deg = 20
helix_angle_deg = )" +
         helix + R"(
face_width_mm = 220
centre_distance_mm = 308
sun_torque_Nm = 56875
sun_speed_rpm = )" +
         speed + R"(
[material]
youngs_modulus_GPa = 206
[sun]
teeth = 21
profile_shift = 0.176
mass_kg = 180
[planet]
teeth = 39
profile_shift = 0.399
mass_kg = 110
[carrier]
mass_kg = 1500
[[ring]]
name = "held"
structure = "traditional"
teeth = 99
profile_shift = 0.974
outside_diameter_mm = 1200
mass_kg = 509
[mesh.sun_planet]
stiffness = "constant"
mean_N_per_m = 3e9
half_backlash_um = 300
[mesh.ring_planet]
stiffness = "constant"
mean_N_per_m = 4e9
half_backlash_um = 300
)";
}

inline std::string bearing(const std::string& name, const std::string& body, const std::string& keys) {
  return "[[bearing]]\nname = \"" + name + "\"\nbody = \"" + body + "\"\n" + keys;
}

/// Carrier bearings with clearance, planets on two rows, a sun in a spline, weight, and a rotor's moment.
inline std::string in_space(const std::string& moment = "[50e3, 100e3, 0]", const std::string& down = "270") {
  return "[gravity]\ndirection_deg = " + down + "\ncarrier_at_mm = -100\n" +
         bearing("upwind row", "planet", "at_mm = -60\nradial_N_per_m = 2e9\naxial_N_per_m = 1e9\n") +
         bearing("downwind row", "planet",
                 "at_mm = 60\nrollers = 18\nroller_length_mm = 60\nroller_diameter_mm = 40\nclearance_um = 60\n") +
         bearing("upwind", "carrier", "at_mm = -300\nradial_N_per_m = 3e9\naxial_N_per_m = 1e9\nclearance_um = 275\n") +
         bearing("downwind", "carrier",
                 "at_mm = 300\nradial_N_per_m = 3e9\nclearance_um = 180\nclearance_law = \"stop\"\n") +
         bearing("spline", "sun", "at_mm = 700\nradial_N_per_m = 5e7\naxial_N_per_m = 3e8\ntilt_Nm_per_rad = 1e6\n") +
         "[[load]]\nname = \"rotor\"\nbody = \"carrier\"\nmoment_Nm = " + moment + "\n";
}

/// The same stage with computed meshes, a pin beside its place and a sun that is held softly.
inline std::string solid_stage() {
  auto scene = helical_stage();
  scene = scene.substr(0, scene.find("[mesh.sun_planet]"));
  scene = test::replaced(scene, "title = \"Helical\"\n", "title = \"Helical\"\naccuracy = 0.05\n");
  scene = test::replaced(scene, "mass_kg = 180\n", "mass_kg = 180\ninertia_kg_m2 = 1\nbore_diameter_mm = 80\n");
  scene = test::replaced(scene, "mass_kg = 110\n", "mass_kg = 110\ninertia_kg_m2 = 3\nbore_diameter_mm = 290\n");
  scene = test::replaced(scene, "mass_kg = 1500\n", "mass_kg = 1500\ninertia_kg_m2 = 45\n");
  scene = test::replaced(scene, "mass_kg = 509\n", "mass_kg = 509\ninertia_kg_m2 = 153\n");
  scene +=
      "[errors]\nplanet_pin_position_error_um = [0, 40, 0]\nplanet_pin_position_error_phase_deg = [0, 210, 0]\n"
      "[supports]\nsun_N_per_m = 2e9\nplanet_N_per_m = 2e9\n"
      "[dynamics]\nhalf_backlash_um = 300\nmesh_damping_ratio = 0.07\nsupport_damping_ratio = 0.03\n"
      "rim_coupling = \"none\"\n[statics]\nmesh_phases = 8\n";
  return scene;
}

/// `annulus statics` of a scene; its files are in `folder`/out.
inline Json solved(const test::TemporaryFolder& folder, const std::string& scene) {
  write_file(folder.path() / "scene.toml", scene);
  const auto outcome = test::run_program(folder.path(), "statics scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
  return Json::parse(read_file(folder.path() / "out/statics.json"));
}

inline double result(const Json& json, const std::string& key) {
  return json.at("rings").at("held").at("results").at(key).at("value").get<double>();
}

/// The largest K_Hβ of the meshes of a kind in the motion of a run.
inline double face_load_factor_in_motion(const Json& summary, const std::string& kind) {
  double most = 0;
  for (const auto& [mesh, face] : summary.at("rings").at("held").at("faces_in_motion").items())
    if (mesh.starts_with(kind)) most = std::max(most, face.at("face_load_factor").get<double>());
  return most;
}

inline Csv table(const test::TemporaryFolder& folder, const std::string& name) {
  return Csv::read(folder.path() / "out/statics/held" / name);
}

}  // namespace annulus::test::statics
