#include "app/report/drawings/transverse_section.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <numbers>

#include "app/report/drawings/dimension.h"
#include "app/report/drawings/support.h"
#include "app/report/plot/frame.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr int section_width = 560;
constexpr double side = 14, above = 26, below = 58;  // page units around the bodies

void extend(Eigen::AlignedBox2d& box, const Eigen::Vector2d& centre, double radius) {
  box.extend(centre + Eigen::Vector2d(radius, radius));
  box.extend(centre - Eigen::Vector2d(radius, radius));
}

Eigen::AlignedBox2d bodies(const TransverseSection& section) {
  Eigen::AlignedBox2d box;
  for (const auto& gears : section.gears)
    for (const auto& place : gears.places)
      extend(box, place.centre, std::max(gears.gear.gear.tip_radius(), gears.gear.outside_radius));
  for (const auto& body : section.bodies)
    for (const auto& point : body.outline) box.extend(point);
  for (const auto& circle : section.circles) extend(box, circle.centre, circle.radius);
  if (section.ring) {
    double reach = section.ring->outside_radius + support_margin(section.ring->structure, section.ring->outside_radius);
    if (const auto flange = section.ring->structure.body(section.ring->outside_radius).flange)
      reach = std::max(reach, flange->outside_radius);
    extend(box, Eigen::Vector2d::Zero(), reach);
  }
  return box;
}

/// Edges of a ring that lie before or behind the section.
std::string edges(const DrawingPage& page, const TransverseSection::Ring& ring) {
  constexpr const char* seen = "fill=\"none\" stroke=\"#2c3a48\" stroke-width=\"0.7\"";
  constexpr const char* hidden = "fill=\"none\" stroke=\"#2c3a48\" stroke-width=\"0.7\" stroke-dasharray=\"4 2\"";
  const Eigen::Vector2d axis(0, 0);
  const auto body = ring.structure.body(ring.outside_radius);
  std::string svg;
  if (body.held_inner_radius > 0) svg += drawn_circle(page, axis, body.held_inner_radius, hidden);
  if (body.hoop) svg += drawn_circle(page, axis, ring.outside_radius + body.hoop->thickness, seen);
  if (body.flange) svg += drawn_circle(page, axis, body.flange->outside_radius, hidden);
  return svg;
}

std::string axis_cross(const DrawingPage& page, const Eigen::Vector2d& centre) {
  const Eigen::Vector2d c = page.at(centre);
  return fmt::format("<path d=\"M{:.1f} {:.1f}h12m-6 -6v12\" stroke=\"#333\" stroke-width=\"0.8\"/>", c.x() - 6, c.y());
}

}  // namespace

std::string to_svg(const TransverseSection& section) {
  const auto box = bodies(section);
  // The gears' x axis points up the page, their y axis to the left.
  constexpr double tallest = 560;
  const double scale = std::min((section_width - 2 * side) / box.sizes().y(), tallest / box.sizes().x());
  const double middle = 0.5 * (box.min().y() + box.max().y());
  const DrawingPage page{scale, 0.5 * section_width + scale * middle, above + scale * box.max().x()};
  const double bottom = page.at(box.min()).y();
  std::string svg = open_svg(section.title, section_width, static_cast<int>(bottom + below), side, section.label);
  for (const auto& gears : section.gears) {
    svg += gear_defs(page, gears.gear);
    for (const auto& place : gears.places) svg += placed_gear(page, gears.gear, place.centre, place.angle);
  }
  if (section.ring) {
    const auto& ring = *section.ring;
    svg += edges(page, ring);
    svg += drawn_supports(page, ring.structure, ring.outside_radius, ring.angle, std::numbers::pi);
  }
  for (const auto& body : section.bodies)
    svg += fmt::format("<path d=\"{}Z\" {}/>", path_through(page, body.outline), body.style);
  for (const auto& circle : section.circles) svg += drawn_circle(page, circle.centre, circle.radius, circle.style);
  for (const auto& gears : section.gears)
    for (const auto& place : gears.places) svg += axis_cross(page, place.centre);
  for (const auto& length : section.lengths)
    svg += dimension(page.at(length.from), page.at(length.to), length.offset,
                     length.symbol + mm_text((length.to - length.from).norm()));
  if (section.outside_radius) {
    const double radius = *section.outside_radius;
    const Eigen::Vector2d left(0, radius), right(0, -radius);
    svg += dimension(page.at(left), page.at(right), page.at(left).y() - bottom - 16, "⌀ " + mm_text(2 * radius));
  }
  svg += scale_bar({side, bottom + 40}, scale, 0.3 * section_width);
  return svg + "</svg>";
}

}  // namespace annulus::app
