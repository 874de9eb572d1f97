#include "geometry/profile.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/errors.h"

namespace annulus::geometry {

namespace {

Eigen::Vector2d mirrored(const Eigen::Vector2d& v) { return {v.x(), -v.y()}; }

}  // namespace

ToothProfile::ToothProfile(const Gear& gear)
    : gear_(gear), fillet_(gear), base_angle_(gear.tooth_half_angle(gear.base_radius())) {}

double ToothProfile::twist() const { return std::tan(gear_.helix_angle()) / gear_.reference_radius(); }

double ToothProfile::roll_length_tip() const { return roll_length_at(gear_.tip_form_radius()); }
double ToothProfile::roll_length_form() const { return fillet_.form_roll(); }

double ToothProfile::roll_length_at(double radius) const {
  const double base = gear_.base_radius();
  return std::sqrt(std::max(0.0, (radius - base) * (radius + base)));
}

// The flank is the end of a string of length rho that leaves the base circle at the polar angle `tangent`; the external
// string turns clockwise with growing rho (towards the tooth centre), the internal one counter-clockwise.
ToothProfile::FlankPlace ToothProfile::flank_place(double roll_length) const {
  const double base = gear_.base_radius();
  const double sign = gear_.kind() == GearKind::external ? 1 : -1;
  const double tangent = base_angle_ - sign * roll_length / base;
  const double c = std::cos(tangent);
  const double s = std::sin(tangent);
  return {{base * c - sign * roll_length * s, base * s + sign * roll_length * c}, {-s, c}};
}

Eigen::Vector2d ToothProfile::flank_point(double roll_length) const { return flank_place(roll_length).point; }
Eigen::Vector2d ToothProfile::flank_normal(double roll_length) const { return flank_place(roll_length).normal; }

double ToothProfile::modification(double roll_length) const {
  const auto& p = gear_.parameters();
  const double tip = roll_length_tip();
  const double form = roll_length_form();
  const double u = std::clamp((roll_length - form) / (tip - form), 0.0, 1.0);  // 0 at the form circle, 1 at the tip
  double removed = p.profile_crowning * (2 * u - 1) * (2 * u - 1);
  removed += p.profile_slope > 0 ? p.profile_slope * u : -p.profile_slope * (1 - u);
  if (p.tip_relief > 0) {
    const double before_tip = (1 - u) * std::abs(tip - form);
    removed += p.tip_relief * std::max(0.0, 1 - before_tip / p.tip_relief_length);
  }
  return removed;
}

double ToothProfile::lead_modification(double z) const {
  const auto& p = gear_.parameters();
  const double u = std::clamp(z / p.face_width, 0.0, 1.0);
  const double slope = p.lead_slope > 0 ? p.lead_slope * u : -p.lead_slope * (1 - u);
  return p.lead_crowning * (2 * u - 1) * (2 * u - 1) + slope;
}

Eigen::Vector2d ToothProfile::project(Boundary boundary, const Eigen::Vector2d& point, double support_radius,
                                      double outside_radius) const {
  const auto on_circle = [&](double radius) -> Eigen::Vector2d { return point * (radius / point.norm()); };
  switch (boundary) {
    case Boundary::support:
      return on_circle(support_radius);
    case Boundary::outside:
      require(std::isfinite(outside_radius), "projection onto an outside diameter that is not given");
      return on_circle(outside_radius);
    case Boundary::tip:
      return on_circle(gear_.tip_form_radius());
    case Boundary::root:
      return on_circle(gear_.root_radius());
    case Boundary::leading_flank: {
      // The normal of an involute touches the base circle: the foot point follows in closed form.
      const double base = gear_.base_radius();
      const double sign = gear_.kind() == GearKind::external ? 1 : -1;
      const double string = roll_length_at(point.norm());
      const double tangent = std::atan2(point.y(), point.x()) - sign * std::atan(string / base);
      const double roll = sign * (base_angle_ - tangent) * base;
      const double tip = roll_length_tip();
      const double form = roll_length_form();
      return flank_point(std::clamp(roll, std::min(tip, form), std::max(tip, form)));
    }
    case Boundary::leading_fillet:
      return fillet_.point(fillet_.nearest(point));
    case Boundary::trailing_flank:
      return mirrored(project(Boundary::leading_flank, mirrored(point), support_radius));
    case Boundary::trailing_fillet:
      return mirrored(project(Boundary::leading_fillet, mirrored(point), support_radius));
    case Boundary::none:
    case Boundary::side_low:
    case Boundary::side_high:
    case Boundary::end_low:
    case Boundary::end_high:
    case Boundary::inner:
    case Boundary::flange_face:
      break;
  }
  return point;
}

Eigen::Vector3d ToothProfile::project_solid(Boundary boundary, const Eigen::Vector3d& point, double support_radius,
                                            double outside_radius) const {
  const Eigen::Rotation2Dd turned(twist() * point.z());
  const Eigen::Vector2d section = turned.inverse() * point.head<2>();
  const Eigen::Vector2d found = turned * project(boundary, section, support_radius, outside_radius);
  return {found.x(), found.y(), point.z()};
}

}  // namespace annulus::geometry
