#pragma once

#include <string>

namespace annulus::test {

/// The pair of the manufacturing-error paper with prescribed stiffness: nothing elastic has to be solved. Made of lines
/// that tests replace.
inline std::string quick_pair() {
  return R"(title = "Quick pair"
[stage]
kind = "helical_pair"
module_mm = 15
pressure_angle_deg = 20
helix_angle_deg = 14
face_width_mm = 150
pinion_torque_Nm = 20000
pinion_speed_rpm = 1500
[material]
youngs_modulus_GPa = 206
[pinion]
teeth = 21
profile_shift = 0
mass_kg = 205
bore_diameter_mm = 150
bearing_transverse_N_per_m = 2e9
bearing_axial_N_per_m = 1e9
[wheel]
teeth = 37
profile_shift = 0
mass_kg = 289
bore_diameter_mm = 260
bearing_transverse_N_per_m = 2e9
bearing_axial_N_per_m = 1e9
[mesh.pinion_wheel]
stiffness = "iso_6336"
ripple = 0.05
[manufacturing_error]
pinion_total_um = 48.927
pinion_tooth_to_tooth_um = 12.927
wheel_total_um = 48.927
wheel_tooth_to_tooth_um = 12.927
[dynamics]
half_backlash_um = 150
mesh_damping_ratio = 0.08
support_damping_ratio = 0.05
)";
}

/// Spur gears whose plane finite elements take a second or two.
inline std::string solved_pair() {
  return R"(title = "Solved pair"
accuracy = 0.03
model = "plane"
[stage]
kind = "helical_pair"
module_mm = 4
pressure_angle_deg = 20
face_width_mm = 40
pinion_torque_Nm = 600
pinion_speed_rpm = 3000
[material]
youngs_modulus_GPa = 206
[pinion]
teeth = 24
profile_shift = 0
mass_kg = 2.3
bore_diameter_mm = 40
bearing_transverse_N_per_m = 1e9
[wheel]
teeth = 36
profile_shift = 0
mass_kg = 5.1
bore_diameter_mm = 60
bearing_transverse_N_per_m = 1e9
[mesh.pinion_wheel]
stiffness = "computed"
[errors]
mesh_error_um = 5
[dynamics]
half_backlash_um = 50
mesh_damping_ratio = 0.08
support_damping_ratio = 0.05
)";
}

}  // namespace annulus::test
