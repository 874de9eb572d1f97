#include "geometry/tooth_outline.h"

#include <cmath>
#include <numbers>

namespace annulus::geometry {

namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Points of a curve behind its start, by halving until the middle of a piece lies on its chord.
template <class Curve>
void add_curve(Points& points, const Curve& curve, double from, double to, double tolerance, int depth = 0) {
  constexpr int deepest = 12;
  const double middle = 0.5 * (from + to);
  const Eigen::Vector2d a = curve(from), b = curve(to);
  // The curves bend one way only, so the middle decides; a first halving keeps short ones from becoming one chord.
  if (depth < 1 || (depth < deepest && (curve(middle) - 0.5 * (a + b)).norm() > tolerance)) {
    add_curve(points, curve, from, middle, tolerance, depth + 1);
    add_curve(points, curve, middle, to, tolerance, depth + 1);
  } else {
    points.push_back(b);
  }
}

Eigen::Vector2d on_circle(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

}  // namespace

std::vector<Eigen::Vector2d> tooth_outline(const ToothProfile& profile, double tolerance) {
  const Gear& gear = profile.gear();
  const auto arc = [](double radius) { return [radius](double angle) { return on_circle(radius, angle); }; };
  // Chamfers lie at 45 degrees and take as much off the width as off the height.
  const double half_tip =
      gear.tooth_half_angle(gear.tip_form_radius()) - gear.parameters().tip_chamfer / gear.tip_radius();
  const Eigen::Vector2d root_end = profile.fillet_point(1);
  // The leading half from the middle of the tip to the middle of the space.
  Points leading = {on_circle(gear.tip_radius(), 0)};
  add_curve(leading, arc(gear.tip_radius()), 0, half_tip, tolerance);
  if (gear.parameters().tip_chamfer > 0) leading.push_back(profile.flank_point(profile.roll_length_tip()));
  add_curve(
      leading, [&](double roll) { return profile.flank_point(roll); }, profile.roll_length_tip(),
      profile.roll_length_form(), tolerance);
  add_curve(
      leading, [&](double t) { return profile.fillet_point(t); }, 0, 1, tolerance);
  add_curve(leading, arc(gear.root_radius()), std::atan2(root_end.y(), root_end.x()), std::numbers::pi / gear.teeth(),
            tolerance);
  Points outline;
  for (auto p = leading.rbegin(); p != leading.rend(); ++p) outline.emplace_back(p->x(), -p->y());
  outline.insert(outline.end(), leading.begin() + 1, leading.end());
  return outline;
}

}  // namespace annulus::geometry
