#pragma once

namespace annulus::geometry {

/// A gear as [ISO1328-1] classifies it.
struct ToleranceGear {
  int teeth = 0;
  double module = 0;              ///< m, normal
  double reference_diameter = 0;  ///< m
  double helix_angle = 0;         ///< rad
};

inline constexpr int best_flank_class = 1, worst_flank_class = 11;

/// F_pT, total cumulative pitch tolerance of a flank tolerance class A [ISO1328-1, 5.3.2], m:
/// (0.002 d + 0.55 sqrt(d) + 0.7 m_n + 12) sqrt(2)^(A - 5) in µm, with d and m_n in mm, rounded as the standard rounds.
/// Throws GeometryError outside the standard's range: classes 1 to 11, 5 to 1000 teeth, reference diameters of 5 to
/// 15 000 mm, normal modules of 0.5 to 70 mm, helix angles up to 45 degrees.
[[nodiscard]] double cumulative_pitch_tolerance(const ToleranceGear& gear, int flank_class);

/// f_pT, single pitch tolerance [ISO1328-1, 5.3.1], m: (0.001 d + 0.4 m_n + 5) sqrt(2)^(A - 5) in µm. Throws as above.
[[nodiscard]] double single_pitch_tolerance(const ToleranceGear& gear, int flank_class);

/// F_rT, runout tolerance: 0.9 of the same expression [ISO1328-1, annex], m. The runout of a gear whose only deviation
/// is an eccentricity is twice the eccentricity. Throws as above.
[[nodiscard]] double runout_tolerance(const ToleranceGear& gear, int flank_class);

}  // namespace annulus::geometry
