#pragma once

#include <string>

#include "geometry/gear.h"

namespace annulus::geometry {

/// Which gear of a pair is meant.
enum class GearRole { pinion, wheel };

/// What messages call the gears of a pair.
struct PairNames {
  std::string pinion = "pinion", wheel = "wheel";
};

/// How far the teeth of a gear reach beyond a face, m.
struct Overhang {
  double below = 0, above = 0;  ///< towards -z and +z
  [[nodiscard]] double total() const { return below + above; }
};

/// The part of the axis on which both gears of a pair have teeth.
struct CommonFace {
  double width = 0;  ///< m
  Overhang pinion, wheel;
};

/// Two gears in mesh at a working centre distance: pinion and wheel, or sun and planet (external), or planet and ring
/// (internal).
///
/// Lengths along the line of action are measured on the *pinion* by its roll length rho = r_b tan(alpha_y), the
/// distance from the tangent point on its base circle; rho grows from root to tip. Of helical gears they are those of a
/// transverse section. Construction throws GeometryError with the reason: different base pitches or helix angles, hands
/// that do not fit (opposite ones for an external pair, equal ones for an internal pair), no working angle, negative
/// backlash, tip interference (a tip that reaches below the mate's form circle or into its root), involute
/// interference, interfering tips of internal gears with few teeth difference (taken without their chamfers), faces
/// that do not overlap, total contact ratio below 1.
class GearPair {
 public:
  /// Centre distance in m.
  GearPair(const Gear& pinion, const Gear& wheel, double centre_distance, GearRole driver, PairNames names = {});
  /// A mesh of a planetary set: `wheel` is the sun (external), which drives the planet, or the ring (internal), which
  /// the planet drives.
  GearPair(const Gear& planet, const Gear& wheel, double centre_distance);

  /// Negative backlash up to this many modules is accepted and reported as it is: profile shifts printed with four
  /// digits and centre distances printed to a hundredth of a millimetre leave that much rounding in a backlash-free
  /// pair.
  static constexpr double backlash_tolerance = 5e-4;

  [[nodiscard]] const Gear& pinion() const { return pinion_; }
  [[nodiscard]] const Gear& wheel() const { return wheel_; }
  [[nodiscard]] bool internal() const { return wheel_.kind() == GearKind::internal; }
  [[nodiscard]] GearRole driver() const { return driver_; }
  /// Mesh cycles after the pitch-point contact of two driving flanks at which the back flanks touch there: the tooth
  /// thickness of the driving gear over the pitch. Back flanks of symmetric teeth are the mirror image of the driving
  /// ones and pass their contact the other way: what these have at a phase, those have at this less the phase.
  [[nodiscard]] double back_flank_phase() const;
  [[nodiscard]] double centre_distance() const { return centre_distance_; }
  [[nodiscard]] double working_pressure_angle() const { return working_pressure_angle_; }  ///< alpha_wt, transverse
  [[nodiscard]] double normal_backlash() const { return normal_backlash_; }  ///< j_bn, m, normal to the flanks
  /// From a tip circle to the root circle of the mate, m.
  struct TipClearance {
    double pinion_tip = 0, wheel_tip = 0;
  };
  [[nodiscard]] TipClearance tip_clearance() const;
  [[nodiscard]] double contact_ratio() const;  ///< epsilon_alpha, transverse
  [[nodiscard]] CommonFace common_face() const;
  /// epsilon_beta = b sin|beta| / (pi m_n) with the width of the common face; 0 for spur gears.
  [[nodiscard]] double overlap_ratio() const;
  [[nodiscard]] double total_contact_ratio() const { return contact_ratio() + overlap_ratio(); }  ///< epsilon_gamma
  /// Theoretical path of contact on the pinion: roll lengths at its two ends and at the pitch point.
  /// Internal mesh: rho_low is set by the tip of the wheel, rho_high by that of the pinion.
  [[nodiscard]] double roll_length_low() const { return roll_low_; }
  [[nodiscard]] double roll_length_high() const { return roll_high_; }
  [[nodiscard]] double roll_length_pitch() const { return roll_pitch_; }
  /// Roll length on the wheel of the point that touches the pinion at `pinion_roll`.
  /// external: a sin(alpha_w) - rho; internal: a sin(alpha_w) + rho.
  [[nodiscard]] double wheel_roll_length(double pinion_roll) const;
  /// 1/m, of both involutes together where they touch: 1/rho + 1/rho_wheel, internal 1/rho - 1/rho_wheel.
  [[nodiscard]] double relative_curvature(double pinion_roll) const;

 private:
  void check_tips() const;
  void check_internal_tips() const;

  Gear pinion_, wheel_;
  GearRole driver_;
  PairNames names_;
  double centre_distance_, working_pressure_angle_, normal_backlash_;
  double roll_low_ = 0, roll_high_ = 0, roll_pitch_ = 0;
};

}  // namespace annulus::geometry
