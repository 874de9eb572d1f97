#include "app/report/drawings/transverse_section.h"

#include <Eigen/Geometry>
#include <numbers>

#include "app/report/drawings/dimension.h"
#include "app/report/drawings/support.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double section_width = 560, side = 14, above = 26, below = 58;  // page units around the bodies

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
  const std::string hidden = std::string(outline_style) + R"( stroke-dasharray="4 2")";
  const Eigen::Vector2d axis(0, 0);
  const auto body = ring.structure.body(ring.outside_radius);
  std::string text;
  if (body.held_inner_radius > 0) text += page.circle(axis, body.held_inner_radius, hidden);
  if (body.hoop) text += page.circle(axis, ring.outside_radius + body.hoop->thickness, outline_style);
  if (body.flange) text += page.circle(axis, body.flange->outside_radius, hidden);
  return text;
}

std::string axis_cross(const svg::Point& centre) {
  const svg::Point across(6, 0), down(0, 6);
  return svg::path(svg::through({centre - across, centre + across}) + svg::through({centre - down, centre + down}),
                   R"(stroke="#333" stroke-width="0.8")");
}

}  // namespace

std::string to_svg(const TransverseSection& section) {
  const auto box = bodies(section);
  // The gears' x axis points up the page, their y axis to the left.
  constexpr double tallest = 560;
  const double scale = std::min((section_width - 2 * side) / box.sizes().y(), tallest / box.sizes().x());
  const DrawingPage page{scale, {0.5 * section_width + scale * box.center().y(), above + scale * box.max().x()}};
  const double bottom = page.at(box.min()).y();
  std::string text;
  for (const auto& gears : section.gears) {
    text += gear_defs(page, gears.gear);
    for (const auto& place : gears.places) text += placed_gear(page, gears.gear, place.centre, place.angle);
  }
  if (const auto& ring = section.ring)
    text +=
        edges(page, *ring) + drawn_supports(page, ring->structure, ring->outside_radius, ring->angle, std::numbers::pi);
  for (const auto& body : section.bodies) text += svg::path(page.through(body.outline) + "Z", body.style);
  for (const auto& circle : section.circles) text += page.circle(circle.centre, circle.radius, circle.style);
  for (const auto& gears : section.gears)
    for (const auto& place : gears.places) text += axis_cross(page.at(place.centre));
  for (const auto& length : section.lengths)
    text += dimension(page.at(length.from), page.at(length.to), length.offset,
                      length.symbol + mm_text((length.to - length.from).norm()));
  if (section.outside_radius) {
    const svg::Point left = page.at({0, *section.outside_radius}), right = page.at({0, -*section.outside_radius});
    text += dimension(left, right, left.y() - bottom - 16, "⌀ " + mm_text(2 * *section.outside_radius));
  }
  text += scale_bar({side, bottom + 40}, scale, 0.3 * section_width);
  return svg::titled_picture(section.title, section.label, section_width, bottom + below, side, text);
}

}  // namespace annulus::app
