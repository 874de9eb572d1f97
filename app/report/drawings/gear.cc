#include "app/report/drawings/gear.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/units.h"
#include "geometry/tooth_outline.h"

namespace annulus::app {

namespace {

constexpr double outline_error = 0.02;  // page units: not to be seen

std::string circle_path(double radius) {
  return fmt::format("M{0:.2f} 0A{1:.2f} {1:.2f} 0 1 0 {1:.2f} 0A{1:.2f} {1:.2f} 0 1 0 {0:.2f} 0Z", -radius, radius);
}

/// Teeth are filled some way down into the body, so that no seam shows between them.
double filled_to(const DrawnGear& drawn) {
  constexpr double overlap = 0.03;
  const double root = drawn.gear.root_radius();
  if (drawn.gear.kind() == geometry::GearKind::internal) return std::min((1 + overlap) * root, drawn.outside_radius);
  return std::max((1 - overlap) * root, drawn.inner_radius);
}

}  // namespace

std::string gear_defs(const DrawingPage& page, const DrawnGear& drawn) {
  const auto& gear = drawn.gear;
  const DrawingPage own{page.scale};
  auto outline = geometry::tooth_outline(geometry::ToothProfile(gear), outline_error / page.scale);
  const auto d = own.through(outline);
  for (const double side : {0.5, -0.5}) outline.push_back(polar(filled_to(drawn), side * gear.pitch_angle()));
  // The body as far as the teeth overlap it.
  const double root = gear.root_radius() * page.scale;
  const double other =
      (gear.kind() == geometry::GearKind::internal ? drawn.outside_radius : drawn.inner_radius) * page.scale;
  std::string body = svg::path(circle_path(root) + (other > 0 ? circle_path(other) : ""),
                               fmt::format(R"(fill="{}" fill-rule="evenodd")", drawn.fill));
  if (other > 0) body += svg::circle({0, 0}, other, outline_style);
  for (int i = 0; i < gear.teeth(); ++i)
    body += fmt::format("<use href=\"#tooth-{}\" transform=\"rotate({:.4f})\"/>", drawn.id,
                        -i * gear.pitch_angle() / units::deg);
  return fmt::format(
      "<defs><g id=\"tooth-{0}\"><path d=\"{1}Z\" fill=\"{2}\"/><path id=\"outline-{0}\" d=\"{3}\" {4}/></g>"
      "<g id=\"gear-{0}\">{5}</g></defs>",
      drawn.id, own.through(outline), drawn.fill, d, outline_style, body);
}

std::string placed_gear(const DrawingPage& page, const DrawnGear& drawn, const Eigen::Vector2d& centre, double angle) {
  const svg::Point c = page.at(centre);
  return fmt::format("<use href=\"#gear-{}\" transform=\"translate({:.3f} {:.3f}) rotate({:.4f})\"/>", drawn.id, c.x(),
                     c.y(), -angle / units::deg);
}

}  // namespace annulus::app
