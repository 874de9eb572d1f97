#pragma once

#include <memory>
#include <optional>

namespace annulus::geometry {

class FlankTopography;

enum class GearKind { external, internal };

/// Input of one spur or helical gear; SI. Module, pressure angle, profile shift and the factors are those of the normal
/// section [ISO21771]. Sign rule for internal gears ([ISO21771] with positive diameters): every diameter and the tooth
/// count are positive and a positive profile shift moves the tooth space outwards, so that x_r - x_p enters the
/// internal mesh and x_s + x_p the external one.
struct GearParameters {
  GearKind kind = GearKind::external;
  int teeth = 0;
  double module = 0;                      ///< m_n, m
  double pressure_angle = 0;              ///< alpha_n, rad
  double profile_shift = 0;               ///< x, in modules
  double face_width = 0;                  ///< m
  std::optional<double> tip_diameter{};   ///< m; absent: addendum of one module
  std::optional<double> root_diameter{};  ///< m; absent: dedendum of 1.25 modules
  double root_fillet_factor = 0.38;       ///< rack tip radius (external) or fillet radius (internal, in the
                                          ///< transverse section) in modules; limited to the full root rounding
  double protuberance = 0;                ///< m, normal to the flank: how far the rounding of the generating rack's
                                          ///< tip reaches beyond the finished flank; external gears only
  double protuberance_angle = 0;          ///< rad, of the rack's flank from there on, below the pressure angle
  double tip_chamfer = 0;                 ///< m, radial height of the chamfers at the tip (h_K)
  double tip_relief = 0;                  ///< m, material removed at the tip, normal to the flank
  double tip_relief_length = 0;           ///< m, along the line of action, linear relief
  double profile_crowning = 0;            ///< m, parabolic, at both ends of the usable flank
  double profile_slope = 0;               ///< m, removed linearly towards the tip (> 0) or the root (< 0), end to end
  double lead_crowning = 0;               ///< m, parabolic, removed at both ends of the face width
  double lead_slope = 0;                  ///< m, removed linearly towards +z (> 0) or -z (< 0), end to end
  double helix_angle = 0;                 ///< beta at the reference cylinder, rad; 0 = spur, > 0 = right hand
  double axial_offset = 0;                ///< m, of the middle of the face along the axis
  /// Measured flanks on either side of the teeth (Boundary::leading_flank), beside the modifications; may be null.
  std::shared_ptr<const FlankTopography> leading_topography{}, trailing_topography{};
};

/// Whether flanks differ from involutes.
[[nodiscard]] bool modified(const GearParameters& parameters);
/// Whether they do so differently along the face.
[[nodiscard]] bool modified_along_face(const GearParameters& parameters);
/// Whether they were measured.
[[nodiscard]] bool measured(const GearParameters& parameters);

/// A gear with its derived dimensions [ISO21771]. Angles and thicknesses on circles are those of the transverse
/// section unless they say otherwise. Construction throws GeometryError with the reason when the gear cannot exist: tip
/// below base, pointed tooth (thinner than 0.2 modules at the tip, in the normal section), deep undercut, no room for a
/// root fillet, non-positive sizes, pressure angle outside 10 to 35 degrees, helix angle beyond 45 degrees.
class Gear {
 public:
  explicit Gear(const GearParameters& parameters);

  [[nodiscard]] const GearParameters& parameters() const { return p_; }
  [[nodiscard]] GearKind kind() const { return p_.kind; }
  [[nodiscard]] int teeth() const { return p_.teeth; }
  [[nodiscard]] double pitch_angle() const;  ///< 2 pi / z, rad
  [[nodiscard]] double helix_angle() const { return p_.helix_angle; }
  [[nodiscard]] double helix_angle_at(double radius) const;  ///< tan(beta_y) = tan(beta) r_y / r, with the sign of beta
  [[nodiscard]] double base_helix_angle() const;             ///< beta_b, rad, with the sign of beta
  [[nodiscard]] double transverse_module() const { return transverse_module_; }  ///< m_t = m_n / cos(beta)
  /// tan(alpha_t) = tan(alpha_n) / cos(beta)
  [[nodiscard]] double transverse_pressure_angle() const { return transverse_pressure_angle_; }
  [[nodiscard]] double reference_radius() const { return transverse_module_ * p_.teeth / 2; }  ///< m_t z / 2
  [[nodiscard]] double base_radius() const { return base_radius_; }                            ///< r_b
  [[nodiscard]] double tip_radius() const;  ///< internal: smaller than the root radius
  /// Where the flank ends towards the tip: at the tip circle, or at its chamfer (d_Fa of [ISO21771]).
  [[nodiscard]] double tip_form_radius() const;
  [[nodiscard]] double root_radius() const;
  /// p_bt = 2 pi r_b / z, distance of teeth along the line of action in the transverse section.
  [[nodiscard]] double base_pitch() const;
  /// Radius at which the involute starts at the root side (form circle: end of the generated trochoid or fillet).
  [[nodiscard]] double form_radius() const { return form_radius_; }
  /// Whether the rack corner cuts into the involute above the base circle: the form circle is then an edge.
  [[nodiscard]] bool undercut() const { return undercut_; }
  /// Half the angle a tooth (the material) covers at radius r >= r_b, from the involutes of both flanks, rad.
  [[nodiscard]] double tooth_half_angle(double radius) const;
  /// Tooth thickness along the arc at radius r, m.
  [[nodiscard]] double tooth_thickness(double radius) const { return 2 * radius * tooth_half_angle(radius); }
  /// Base tangent length W_k over k teeth (external) or k spaces (internal), without backlash, normal to the flanks,
  /// [ISO21771], m. Of a helical gear it can be measured when the face width exceeds W_k sin(beta_b).
  [[nodiscard]] double base_tangent_length(int k) const;

 private:
  GearParameters p_;
  double transverse_module_ = 0, transverse_pressure_angle_ = 0, base_radius_ = 0;  // asked for in inner loops
  double form_radius_ = 0;
  bool undercut_ = false;
};

/// inv(alpha) = tan(alpha) - alpha, rad, and its inverse for values >= 0.
[[nodiscard]] double involute(double angle);
[[nodiscard]] double inverse_involute(double value);

}  // namespace annulus::geometry
