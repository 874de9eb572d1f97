#pragma once

#include <string>

namespace annulus::test {

/// The 2KV-6 reducer with given mesh stiffness: nothing elastic has to be solved. Made of lines that tests replace.
inline std::string reducer_scene() {
  return R"(title = "Reducer"
[stage]
kind = "two_k_v"
planets = 2
module_mm = 1
pressure_angle_deg = 20
face_width_mm = 10
[material]
youngs_modulus_GPa = 206
[sun]
teeth = 10
profile_shift = 0.45
inertia_kg_m2 = 9.2e-8
[planet]
teeth = 34
profile_shift = -0.45
mass_kg = 0.1083
inertia_kg_m2 = 1.03e-5
[crank]
inertia_kg_m2 = 4.6e-7
shaft_Nm_per_rad = 3141
bearing_N_per_m = 1.5e8
[arc_gear]
pins = 30
eccentricity_mm = 0.9
pin_circle_diameter_mm = 80
pin_diameter_mm = 4
arc_radius_mm = 2.2
width_mm = 8
mass_kg = 0.24
inertia_kg_m2 = 1.8e-4
bearing_N_per_m = 1.500e8
[input]
inertia_kg_m2 = 8.405e-6
shaft_Nm_per_rad = 536
[output]
torque_Nm = 58
speed_rpm = 30
inertia_kg_m2 = 4.5e-4
support_Nm_per_rad = inf
[mesh.sun_planet]
stiffness = "constant"
mean_N_per_m = 1.4e8
[mesh.arc_pins]
stiffness = "constant"
mean_N_per_m = 7.5e8
[dynamics]
half_backlash_um = 0
mesh_damping_ratio = 0.05
support_damping_ratio = 0.05
)";
}

}  // namespace annulus::test
