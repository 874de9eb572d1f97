#pragma once

#include <stdexcept>
#include <string>

#include "core/files.h"
#include "tests/temporary_folder.h"

namespace annulus::test {

/// A complete scene with prescribed stiffness: nothing elastic has to be solved. Made of lines that tests replace.
inline std::string quick_scene() { return read_file(ANNULUS_SOURCE_DIR "/tests/app/quick_scene.toml"); }

/// The errors of the quick scene.
inline std::string quick_errors() {
  return "planet_eccentricity_um = [15, 36, 17, 38, 19]\nplanet_eccentricity_phase_deg = [0, 0, 0, 0, 0]\n";
}

/// Four planets between a sun of 24 and a ring of 72 teeth of module 4 mm, 200 kW at 1500 r/min; meshes are computed.
inline std::string small_stage() {
  return R"(title = "Promise"
[stage]
kind = "planetary"
planets = 4
module_mm = 4
pressure_angle_deg = 20
face_width_mm = 60
centre_distance_mm = 96
power_kW = 200
sun_speed_rpm = 1500
[material]
youngs_modulus_GPa = 206
[sun]
teeth = 24
profile_shift = 0
bore_diameter_mm = 40
mass_kg = 3.3
inertia_kg_m2 = 0.0038
[planet]
teeth = 24
profile_shift = 0
bore_diameter_mm = 45
mass_kg = 2.9
inertia_kg_m2 = 0.0036
[carrier]
mass_kg = 18
inertia_kg_m2 = 0.15
[[ring]]
name = "ring"
structure = "traditional"
teeth = 72
tip_diameter_mm = 282
profile_shift = 0
rim_thickness_mm = 24
mass_kg = 14
inertia_kg_m2 = 0.35
[errors]
planet_pin_position_error_um = [10, 0, 0, 0]
planet_pin_position_error_phase_deg = [90, 0, 0, 0]
[supports]
sun_N_per_m = 1e8
planet_N_per_m = 1e9
[dynamics]
half_backlash_um = 50
mesh_damping_ratio = 0.07
support_damping_ratio = 0.03
)";
}

/// `text` with the first occurrence of `what` replaced.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("test scene has no '" + what + "'");
  return text.replace(at, what.size(), by);
}

/// A ring on pins, its mesh solved in the plane; the sun's stiffness is prescribed. Two ring positions and few mesh
/// cycles.
inline std::string pinned_scene() {
  auto text = replaced(quick_scene(), "structure = \"traditional\"\n",
                       "structure = \"pinned\"\npins = 81\npin_diameter_mm = 15.5\n");
  text = replaced(text, "title = \"Quick\"\n", "title = \"Quick\"\naccuracy = 0.05\n");
  text = replaced(text, "[sun]\n", "[sun]\nbore_diameter_mm = 130\n");
  text = replaced(text, "[planet]\n", "[planet]\nbore_diameter_mm = 172\n");
  text = replaced(text, "planet_N_per_m = 1e9\n", "planet_N_per_m = 1e9\nring_N_per_m = 1e9\n");
  text = replaced(text, "[mesh.ring_planet]\nstiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294\n", "");
  for (const std::string unit : {"_um", "_phase_deg"})
    text = replaced(text, "planet_eccentricity" + unit, "planet_pin_position_error" + unit);
  return replaced(text, "mesh_cycles = 110\n", "mesh_cycles = 4\n");
}

}  // namespace annulus::test
