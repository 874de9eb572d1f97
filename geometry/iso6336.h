#pragma once

#include <optional>

#include "geometry/gear_pair.h"

/// Formulas of ISO 6336:2006, method B, for spur gears: figures of the standard to stand beside computed ones. Every
/// function throws GeometryError for helical gears. Gear 1 of the standard is the one with fewer teeth; in an external
/// pair that need not be the pinion of GearPair.
namespace annulus::geometry {

struct Iso6336Bodies {
  double gear_blank = 1;          ///< C_R, 1 for solid discs
  double correction = 0.8;        ///< C_M, measured over theoretical stiffness
  double youngs_modulus = 206e9;  ///< Pa, of both gears; the standard's steel has 206 GPa
};

/// C_R = 1 + ln(b_s / b) / (5 exp(s_R / (5 m))) [ISO6336-1, 9.3.2.3] of a web of thickness b_s (m) in a gear of face
/// width b (m), with the rim thickness s_R in modules. b_s / b counts as at least 0.2 and at most 1.2, s_R / m as at
/// least 1.
[[nodiscard]] double gear_blank_factor(double web_thickness, double face_width, double rim_thickness_in_modules);

/// c_gamma_alpha / c' = 0.75 epsilon_alpha + 0.25 [ISO6336-1], for epsilon_alpha >= 1.2.
[[nodiscard]] constexpr double mesh_over_single_stiffness(double transverse_contact_ratio) {
  return 0.75 * transverse_contact_ratio + 0.25;
}

/// Stiffness per face width, Pa (1 N/(mm um) = 1e9 Pa).
struct Iso6336Stiffness {
  double theoretical = 0;  ///< c'_th C_B E / E_st: tooth pair with solid bodies, as calculated
  double single = 0;       ///< c' = c'_th C_B C_M C_R E / E_st
  double mesh = 0;         ///< c_gamma_alpha
  double mesh_beta = 0;    ///< c_gamma_beta = 0.85 c_gamma_alpha
};

/// [ISO6336-1, 9.3.1], for a specific load of at least 100 N/mm. 1 / z_2 of an internal gear is 0, its x_2 has the sign
/// rule of the standard (tooth count negative), opposite to that of GearParameters. C_B takes the mean dedendum of both
/// gears.
[[nodiscard]] Iso6336Stiffness iso_6336_stiffness(const GearPair& pair, const Iso6336Bodies& bodies = {});

/// sigma_H0 = Z_H Z_E Z_epsilon sqrt(F_t / (d_1 b) (u + 1) / u) [ISO6336-2], Pa: pressure at the pitch point under the
/// nominal force F_t (N) at the reference circle. u is negative for internal pairs. `contact_modulus`: E* of both
/// materials, Z_E^2 = E* / pi.
[[nodiscard]] double nominal_flank_pressure(const GearPair& pair, double tangential_force, double contact_modulus);
/// Z_epsilon = sqrt((4 - epsilon_alpha) / 3) [ISO6336-2]: mean share of a tooth pair in the force at the pitch point.
[[nodiscard]] double contact_ratio_factor(const GearPair& pair);

/// Pinion-type cutter of an internal gear.
struct PinionCutter {
  int teeth = 0;
  double profile_shift = 0;  ///< in modules
  double tip_radius = 0;     ///< rho_fP of the gear's basic rack, in modules
};

/// Critical section of a tooth root and its factors [ISO6336-3, 6.2]; lengths in m.
struct RootSection {
  double face_width = 0;         ///< m: the common face and of an overhang up to one module [ISO6336-3, 5.3]
  double chord = 0;              ///< s_Fn, at the 30 degree tangents (internal: 60 degree)
  double lever = 0;              ///< h_Fe, of a force at the outer point of single pair contact
  double fillet_radius = 0;      ///< rho_F
  double load_angle = 0;         ///< alpha_Fen, rad
  double form_factor = 0;        ///< Y_F
  double stress_correction = 0;  ///< Y_S
};

/// Root of the pinion or the wheel of a pair with a contact ratio from 1 to 2. The dedendum is that of the gear's root
/// diameter, the rack's tip radius that of an external gear's root_fillet_factor. The root of an internal gear is that
/// of a cutter, not the circular fillet of ToothProfile. Throws GeometryError for an internal gear without a cutter, an
/// external one with one, and a section that cannot be found.
[[nodiscard]] RootSection root_section(const GearPair& pair, const Gear& gear,
                                       const std::optional<PinionCutter>& cutter = {});
/// sigma_F0 = F_t / (b m) Y_F Y_S [ISO6336-3], Pa, for thick rims; F_t (N) at the reference circle.
[[nodiscard]] double nominal_root_stress(const Gear& gear, const RootSection& root, double tangential_force);

/// Y_B [ISO6336-3] of a rim of thickness `rim` (m) between the root and a bore or the outside, as a factor of the root
/// stress: 1 from 1.2 tooth heights on (internal: 3.5 modules). Thinner than half a tooth height (1.75 modules) counts
/// as that: the standard advises against it.
[[nodiscard]] double rim_thickness_factor(const Gear& gear, double rim);

}  // namespace annulus::geometry
