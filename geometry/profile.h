#pragma once

#include <Eigen/Core>

#include "core/not_known.h"
#include "geometry/gear.h"
#include "geometry/root_fillet.h"

namespace annulus::geometry {

/// Boundaries of a tooth sector. A gear's own frame has the axis at the origin and tooth 0 centred on the +x axis;
/// the *leading* flank is the one on the counter-clockwise side (y > 0), the *trailing* flank its mirror image.
enum class Boundary : int {
  none = 0,
  support = 1,    ///< bore (external) or outside diameter (internal)
  side_low = 2,   ///< radial cut at angle -pi/z
  side_high = 3,  ///< radial cut at angle +pi/z
  tip = 4,
  leading_flank = 5,
  trailing_flank = 6,
  leading_fillet = 7,
  trailing_fillet = 8,
  root = 9,
  end_low = 10,      ///< face at the smallest z (3D)
  end_high = 11,     ///< face at the largest z (3D)
  inner = 12,        ///< other free surfaces (the inside of a sleeve)
  outside = 13,      ///< outside diameter of a ring whose hoop or flange (bounded by `support`) goes beyond it (3D)
  flange_face = 14,  ///< bolted face of a flange: its lower face beyond the ring's outside diameter (3D)
};

/// The flank on the other side of a tooth.
[[nodiscard]] constexpr Boundary opposite_flank(Boundary flank) {
  return flank == Boundary::leading_flank ? Boundary::trailing_flank : Boundary::leading_flank;
}

/// The exact outline of one tooth: involute flanks with modifications left out, root fillets (generated trochoid for
/// external gears, circular for internal ones), root and tip circles. A tooth with a tip chamfer ends at the circle
/// where the chamfer begins: what is beyond it carries next to nothing. Of a helical gear it is the transverse section
/// at z = 0; at another z it is turned by twist() z about the axis.
class ToothProfile {
 public:
  explicit ToothProfile(const Gear& gear);

  [[nodiscard]] const Gear& gear() const { return gear_; }
  /// tan(beta) / r, rad/m: the angle by which the section turns (counter-clockwise for a right hand) per metre of z.
  [[nodiscard]] double twist() const;

  /// Roll lengths rho = r_b tan(alpha_y) of the usable involute, m: at the tip and at the form circle. An internal gear
  /// has its tip at the smaller one.
  [[nodiscard]] double roll_length_tip() const;
  [[nodiscard]] double roll_length_form() const;
  [[nodiscard]] double roll_length_at(double radius) const;

  /// Point of the leading flank (mirror in y for the trailing one) at roll length rho, without modifications.
  [[nodiscard]] Eigen::Vector2d flank_point(double roll_length) const;
  /// Unit normal there in the transverse section, pointing out of the material. The normal of a helical flank leans out
  /// of this section by the base helix angle: a thickness normal to the flank is 1 / cos(beta_b) times as long in it.
  [[nodiscard]] Eigen::Vector2d flank_normal(double roll_length) const;
  struct FlankPlace {
    Eigen::Vector2d point, normal;
  };
  /// Both at once.
  [[nodiscard]] FlankPlace flank_place(double roll_length) const;
  /// Material removed normal to the flank, m, >= 0: tip relief rising linearly over the last `tip_relief_length` before
  /// the end of the flank, a parabola of height `profile_crowning` at both its ends, and `profile_slope` from the form
  /// circle to the tip (> 0) or the other way (< 0). Beyond them the end value holds.
  [[nodiscard]] double modification(double roll_length) const;
  /// Material removed normal to the flank along the face width b, m, >= 0, z from 0 to b ([ISO21771], lead crowning and
  /// helix slope): the parabola lead_crowning (2 z / b - 1)^2, plus lead_slope z / b when the slope is positive and
  /// |lead_slope| (1 - z / b) when it is negative. Beyond the ends the end value holds.
  [[nodiscard]] double lead_modification(double z) const;

  /// Fillet point of the leading side, t in [0, 1] from the form circle to the root circle.
  [[nodiscard]] Eigen::Vector2d fillet_point(double t) const { return fillet_.point(t); }
  /// Unit tangent there, towards growing t.
  [[nodiscard]] Eigen::Vector2d fillet_tangent(double t) const { return fillet_.tangent(t); }

  /// The point of the exact boundary curve of tooth 0 nearest to `point`, to rounding, without modifications; beyond
  /// the ends of a flank or fillet its end point. Boundaries without a curve of their own (sides, ends, inner,
  /// flange_face, none) return `point`. Used for meshing and refinement: `point` has to lie nearer to the curve than
  /// its centre of curvature. `outside_radius` is needed for Boundary::outside only (ExtrudeOptions::outside_radius),
  /// m.
  [[nodiscard]] Eigen::Vector2d project(Boundary boundary, const Eigen::Vector2d& point, double support_radius,
                                        double outside_radius = not_known) const;
  /// The same on the body extruded with twist(): the point of the boundary curve in the section at the point's own z.
  [[nodiscard]] Eigen::Vector3d project_solid(Boundary boundary, const Eigen::Vector3d& point, double support_radius,
                                              double outside_radius = not_known) const;

 private:
  Gear gear_;
  RootFillet fillet_;
  double base_angle_;  ///< half angle of the tooth on the base circle, where the involute starts
};

}  // namespace annulus::geometry
