#pragma once

#include <Eigen/Core>
#include <utility>

#include "geometry/gear.h"

namespace annulus::geometry {

/// Root fillet on the leading side of tooth 0, in the gear's own frame (see profile.h); SI.
///
/// External: envelope of the rounded tip corner of the generating rack [LitvinFuentes2004, ch. 6]. The rack touches the
/// fillet along its corner normal, which makes an angle beta with the centre line of the space: beta = 0 on the root
/// circle, beta = pi/2 - alpha_t where the fillet meets the involute. The rack of a helical gear has a circular corner
/// in its normal section; its transverse section, which rolls on the transverse section of the gear, has an elliptic
/// one, wider by 1 / cos(helix angle). That is exact, not an approximation. Internal: a circular arc tangent to
/// involute and root circle, in the transverse section of a helical gear too.
///
/// Where the corner undercuts, its path crosses the involute: the fillet then ends there, in an edge, above the base
/// circle. A rack with a protuberance always leaves such an edge: its corner touches a parallel to the flank, further
/// out by the protuberance, and from the corner a flank of a smaller angle leads back to the main one. That flank
/// generates an involute of its own, up to where it crosses the finished one.
///
/// The radius is limited to what the tooth space can hold: half a root land of at least `min_root_land` modules stays,
/// so that a wanted radius that is too large gives the full root rounding.
class RootFillet {
 public:
  /// Uses only the radii and thicknesses of `gear`, not its form radius. Throws GeometryError with the reason:
  /// undercut of more than two modules of roll length, root too deep for the generating rack, no room for a fillet in
  /// the space.
  explicit RootFillet(const Gear& gear);

  static constexpr double min_root_land = 0.02;       ///< half the root land, modules
  static constexpr double min_radius = 0.05;          ///< smallest fillet radius accepted, modules
  static constexpr double least_protuberance = 1e-6;  ///< modules; less is none
  static constexpr double least_protuberance_angle = 2 * 3.14159265358979323846 / 180;  ///< rad

  /// Rack tip radius in the normal section (external) or fillet radius (internal), m.
  [[nodiscard]] double radius() const { return radius_; }
  /// Roll length r_b tan(alpha) at which the fillet leaves the involute, m.
  [[nodiscard]] double form_roll() const { return form_roll_; }
  [[nodiscard]] bool undercut() const { return undercut_; }  ///< without a protuberance too
  /// Polar angle at which the fillet meets the root circle (leading side), rad.
  [[nodiscard]] double root_angle() const;
  /// Largest polar angle of the space: its centre line at pi / z.
  [[nodiscard]] double space_angle() const { return space_angle_; }

  [[nodiscard]] Eigen::Vector2d point(double t) const;    ///< t in [0, 1] from involute to root circle
  [[nodiscard]] Eigen::Vector2d tangent(double t) const;  ///< unit vector towards growing t
  /// Parameter t of the point nearest to `q`, which has to lie nearer than the centre of curvature.
  [[nodiscard]] double nearest(const Eigen::Vector2d& q) const;

 private:
  void generate(const Gear& gear);  ///< external
  /// Ends the fillet where it crosses the involute; `transverse`: pressure angle.
  void cut_involute(const Gear& gear, double transverse);
  /// Transverse angle and length of the protuberance's flank, on the rack.
  void add_ramp(const Gear& gear);
  void inscribe(const Gear& gear);  ///< internal

  GearKind kind_;
  /// External: the contact of the rack's corner that touches along the normal angle beta.
  struct RackContact {
    double phi = 0;    ///< polar angle of the instantaneous pole, on the pitch circle, from the centre of the space
    double reach = 0;  ///< from the pole to the contact point along the normal, m
  };
  [[nodiscard]] RackContact rack_contact(double beta) const;
  /// The contact at a parameter t, and its normal angle.
  [[nodiscard]] std::pair<RackContact, double> contact(double t) const;

  double space_angle_, reference_radius_, base_radius_, root_radius_;
  double radius_ = 0, form_roll_ = 0;
  bool undercut_ = false;
  // external: rack corner centre beside the rack tooth's centre line and below the pitch line, half width of the corner
  // ellipse (its half height is the radius), largest beta
  double corner_x_ = 0, corner_depth_ = 0, corner_width_ = 0, beta_end_ = 0;
  // the protuberance's flank beyond the corner: its length on the transverse rack, and its share of the parameter t
  double ramp_ = 0, ramp_share_ = 0;
  // internal: arc centre, polar angle of the arc's first normal, swept angle
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  double arc_start_ = 0, arc_sweep_ = 0;
};

}  // namespace annulus::geometry
