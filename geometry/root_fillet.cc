#include "geometry/root_fillet.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/units.h"

namespace annulus::geometry {

namespace {

constexpr double half_pi = std::numbers::pi / 2;

Eigen::Vector2d radial_direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Root of a monotone function with a change of sign in [a, b], to the last few bits.
template <class Function>
double bracketed_root(const Function& f, double a, double b, double fa, double fb) {
  std::uintmax_t evaluations = 100;
  const auto [low, high] =
      boost::math::tools::toms748_solve(f, a, b, fa, fb, boost::math::tools::eps_tolerance<double>(51), evaluations);
  return 0.5 * (low + high);
}

}  // namespace

RootFillet::RootFillet(const Gear& gear)
    : kind_(gear.kind()),
      space_angle_(std::numbers::pi / gear.teeth()),
      reference_radius_(gear.reference_radius()),
      base_radius_(gear.base_radius()),
      root_radius_(gear.root_radius()) {
  if (kind_ == GearKind::external) {
    generate(gear);
  } else {
    inscribe(gear);
  }
}

void RootFillet::generate(const Gear& gear) {
  const auto& p = gear.parameters();
  const double m = p.module;
  const double alpha = p.pressure_angle;
  const double transverse = gear.transverse_pressure_angle();
  const double widening = 1 / std::cos(p.helix_angle);  // from the normal to the transverse section of the rack
  // Half the rack tooth at its tip, which cuts the root circle, in the normal section; the rack's datum line lies x m
  // outside the pitch line.
  const double depth = reference_radius_ + p.profile_shift * m - root_radius_;
  const double half_tip = std::numbers::pi * m / 4 - depth * std::tan(alpha) + p.protuberance / std::cos(alpha);
  // From the sharp rack corner to the point where its rounding starts, per unit of radius.
  const double setback = (1 - std::sin(alpha)) / std::cos(alpha);
  radius_ = std::min(p.root_fillet_factor * m, (half_tip - min_root_land * m) / setback);
  if (radius_ < min_radius * m) {
    throw GeometryError(
        fmt::format("the root of the external gear with {} teeth cannot be generated: the rack tooth for the root "
                    "diameter {:.4f} mm is {:.4f} mm wide at its tip. This is too narrow for the smallest root fillet "
                    "of {} modules; use a larger root diameter or a smaller pressure angle",
                    p.teeth, 2 * root_radius_ / units::mm, 2 * half_tip / units::mm, min_radius));
  }
  corner_x_ = (half_tip - radius_ * setback) * widening;
  corner_depth_ = reference_radius_ - root_radius_ - radius_;
  corner_width_ = radius_ * widening;
  beta_end_ = half_pi - transverse;
  form_roll_ = reference_radius_ * std::sin(transverse) - rack_contact(beta_end_).reach;
  const bool protrudes = p.protuberance > least_protuberance * m;
  if (protrudes) add_ramp(gear);
  if (form_roll_ < 0 || protrudes) cut_involute(gear, transverse);
  // Regular envelope: the radius has to grow along the whole fillet (only far too large positive shifts fail).
  const double c = std::cos(beta_end_), reach = rack_contact(beta_end_).reach;
  const double curvature_radius =
      std::pow(corner_width_ * radius_, 2) / std::pow(std::hypot(corner_width_ * std::sin(beta_end_), radius_ * c), 3);
  if (reference_radius_ * curvature_radius + reach * (reach - curvature_radius) / c <= 0) {
    throw GeometryError(
        fmt::format("the root fillet of the external gear with {} teeth and profile shift {:.4f} cannot be generated; "
                    "use a smaller profile shift or root diameter",
                    p.teeth, p.profile_shift));
  }
}

void RootFillet::add_ramp(const Gear& gear) {
  const auto& p = gear.parameters();
  // Both flanks of the transverse rack: tan of their angles.
  const double main = std::tan(gear.transverse_pressure_angle()),
               ramp = std::tan(p.protuberance_angle) / std::cos(p.helix_angle);
  // The protuberance moves the rack's flank outwards by this; the corner's contact with it lies above its contact with
  // the flatter flank's.
  const double moved = p.protuberance / std::cos(p.pressure_angle) / std::cos(p.helix_angle);
  const auto on_corner = [&](double beta) {
    const auto contact = rack_contact(beta);
    return Eigen::Vector2d(contact.phi * reference_radius_ + contact.reach * std::sin(beta),
                           contact.reach * std::cos(beta));  // x, depth
  };
  const Eigen::Vector2d touch = on_corner(half_pi - std::atan(main));
  beta_end_ = half_pi - std::atan(ramp);
  const Eigen::Vector2d start = on_corner(beta_end_);
  // x over the depth: touch.x - moved + (touch.y - depth) main and start.x + (start.y - depth) ramp.
  const double beyond = start.x() - (touch.x() - moved + (touch.y() - start.y()) * main);
  ramp_ = std::max(0.0, beyond / (main - ramp)) / std::cos(std::atan(ramp));
  ramp_share_ = ramp_ / (ramp_ + corner_width_ * beta_end_);
}

void RootFillet::cut_involute(const Gear& gear, double transverse) {
  const auto& p = gear.parameters();
  // Polar angle of the fillet beyond the involute at its radius: negative inside of the tooth. The involute has no part
  // below the base circle.
  const auto beyond = [&](double t) {
    const Eigen::Vector2d q = point(t);
    return std::atan2(q.y(), q.x()) - gear.tooth_half_angle(std::max(q.norm(), base_radius_));
  };
  const double middle = ramp_share_ + (1 - ramp_share_) / 2;
  const auto [deepest, depth] = boost::math::tools::brent_find_minima(beyond, 0.0, middle, 40);
  const double last = beyond(0);
  constexpr double most = 2;  // modules of roll length; cells of deeper undercuts were not looked at
  if (depth < 0 && last > 0) {
    const double t = bracketed_root(beyond, 0.0, deepest, last, depth), radius = point(t).norm();
    const double over = std::sqrt(std::max(0.0, (radius - base_radius_) * (radius + base_radius_)));
    if (radius > base_radius_ && -form_roll_ <= most * p.module) {
      undercut_ = form_roll_ < 0;
      form_roll_ = over;
      if (t < ramp_share_) {
        ramp_ *= 1 - t / ramp_share_;
        ramp_share_ = ramp_ / (ramp_ + corner_width_ * beta_end_);
      } else {
        beta_end_ *= (1 - t) / (1 - ramp_share_);
        ramp_ = ramp_share_ = 0;
      }
      return;
    }
  }
  if (p.protuberance > 0 && -form_roll_ <= most * p.module)
    throw GeometryError(fmt::format(
        "the protuberance of {:.4f} mm leaves no involute on the external gear with {} teeth; reduce it or its angle",
        p.protuberance / units::mm, p.teeth));
  throw GeometryError(fmt::format(
      "the external gear with {} teeth is undercut: the rack corner reaches {:.4f} mm beyond the start of the "
      "involute, of which up to {} modules are modelled; raise the profile shift from {:.4f} by {:.4f} or use more "
      "teeth",
      p.teeth, -form_roll_ / units::mm, most, p.profile_shift, -form_roll_ * std::sin(transverse) / p.module));
}

// The contact point lies where the corner has the normal (sin beta, -cos beta) in rack coordinates, x along the pitch
// line from the centre of the rack tooth, y outwards; its normal meets the pitch line at the pole.
RootFillet::RackContact RootFillet::rack_contact(double beta) const {
  const double c = std::cos(beta);
  const double s = std::sin(beta);
  const double support = std::hypot(corner_width_ * s, radius_ * c);
  const double x = corner_x_ + corner_width_ * corner_width_ * s / support;
  const double depth = corner_depth_ + radius_ * radius_ * c / support;
  return {(x - depth * s / c) / reference_radius_, depth / c};
}

std::pair<RootFillet::RackContact, double> RootFillet::contact(double t) const {
  if (t >= ramp_share_) {
    const double beta = (1 - t) / (1 - ramp_share_) * beta_end_;
    return {rack_contact(beta), beta};
  }
  // Along the straight flank the normal stays; the place on it moves out of the corner.
  auto at = rack_contact(beta_end_);
  const double length = (1 - t / ramp_share_) * ramp_, c = std::cos(beta_end_), s = std::sin(beta_end_);
  at.reach -= length * s / c;
  at.phi += (length * c + length * s * s / c) / reference_radius_;
  return {at, beta_end_};
}

void RootFillet::inscribe(const Gear& gear) {
  const auto& p = gear.parameters();
  const double m = p.module;
  const double base_angle = gear.tooth_half_angle(base_radius_);
  const double limit = space_angle_ - min_root_land * m / root_radius_;
  // Angle of the arc's centre: it has to stay on this side of the centre of the space.
  const auto roll = [&](double radius) {
    const double reach = root_radius_ - radius;
    return reach > base_radius_ ? radius + std::sqrt(reach * reach - base_radius_ * base_radius_) : radius;
  };
  const auto excess = [&](double radius) {
    const double rho = roll(radius);
    return base_angle + rho / base_radius_ - std::atan((rho - radius) / base_radius_) - limit;
  };
  radius_ = std::min(p.root_fillet_factor * m, root_radius_ - base_radius_);
  const double smallest = min_radius * m;
  if (radius_ < smallest) {
    throw GeometryError(fmt::format(
        "the root circle of the internal gear with {} teeth (diameter {:.4f} mm) lies less than the smallest root "
        "fillet, {} modules, outside its base circle ({:.4f} mm); use a larger root diameter",
        p.teeth, 2 * root_radius_ / units::mm, min_radius, 2 * base_radius_ / units::mm));
  }
  if (excess(smallest) > 0) {
    throw GeometryError(fmt::format(
        "the space of the internal gear with {} teeth is too narrow at the root diameter {:.4f} mm even for the "
        "smallest root fillet, {} modules (the root fillet factor is {}); use a smaller root diameter",
        p.teeth, 2 * root_radius_ / units::mm, min_radius, p.root_fillet_factor));
  }
  if (excess(radius_) > 0) radius_ = bracketed_root(excess, smallest, radius_, excess(smallest), excess(radius_));
  form_roll_ = roll(radius_);
  const double tangent_angle = base_angle + form_roll_ / base_radius_;  // of the tangent point on the base circle
  const double centre_angle = tangent_angle - std::atan((form_roll_ - radius_) / base_radius_);
  centre_ = (root_radius_ - radius_) * radial_direction(centre_angle);
  arc_start_ = tangent_angle - half_pi;
  arc_sweep_ = centre_angle - arc_start_;
}

double RootFillet::root_angle() const {
  if (kind_ == GearKind::internal) return arc_start_ + arc_sweep_;
  return space_angle_ - corner_x_ / reference_radius_;
}

Eigen::Vector2d RootFillet::point(double t) const {
  if (kind_ == GearKind::internal) return centre_ + radius_ * radial_direction(arc_start_ + t * arc_sweep_);
  const auto [at, beta] = contact(t);
  const Eigen::Vector2d pole = radial_direction(space_angle_ - at.phi);
  const Eigen::Vector2d towards_tooth(pole.y(), -pole.x());
  return (reference_radius_ - at.reach * std::cos(beta)) * pole + at.reach * std::sin(beta) * towards_tooth;
}

Eigen::Vector2d RootFillet::tangent(double t) const {
  if (kind_ == GearKind::internal) return radial_direction(arc_start_ + t * arc_sweep_ + half_pi);
  const auto [at, beta] = contact(t);
  return -radial_direction(space_angle_ - at.phi - half_pi + beta);
}

double RootFillet::nearest(const Eigen::Vector2d& q) const {
  if (kind_ == GearKind::internal) {
    const Eigen::Vector2d d = q - centre_;
    const double angle = std::remainder(std::atan2(d.y(), d.x()) - arc_start_, 2 * std::numbers::pi);
    return std::clamp(angle / arc_sweep_, 0.0, 1.0);
  }
  // (q - pole) . tangent = 0, with pole . tangent = r sin(beta) in closed form.
  const auto along = [&](double t) { return q.dot(tangent(t)) + reference_radius_ * std::sin(contact(t).second); };
  const double at_form = along(0);
  const double at_root = along(1);
  if (at_form <= 0) return 0;
  if (at_root >= 0) return 1;
  return bracketed_root(along, 0.0, 1.0, at_form, at_root);
}

}  // namespace annulus::geometry
