#include "app/report/drawings/support.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double least_margin = 6 * units::mm;
constexpr const char* support_style = "fill=\"#D55E00\" fill-opacity=\"0.75\" stroke=\"#7a3600\" stroke-width=\"0.8\"";

/// Outlines of teeth on the outside with their flank angle, as wide as their spaces; a sketch: no input says their
/// height.
std::string outside_teeth(const DrawingPage& page, const fem::RingDrawing::OutsideTeeth& teeth, double radius,
                          double first, double reach) {
  std::string d;
  const double quarter = std::numbers::pi / 2 / static_cast<double>(teeth.angles.size());
  const double height = std::min(quarter * radius, least_margin - 1 * units::mm);
  const double top = quarter - height * std::tan(teeth.flank_angle) / radius;
  for (const double own : teeth.angles) {
    const double angle = std::remainder(own, 2 * std::numbers::pi) + first;
    if (std::abs(angle - first) > reach) continue;
    d += path_through(page, {polar(radius, angle - quarter), polar(radius + height, angle - top),
                             polar(radius + height, angle + top), polar(radius, angle + quarter)}) +
         "Z";
  }
  return fmt::format("<path d=\"{}\" {} vector-effect=\"non-scaling-stroke\"/>", d, support_style);
}

}  // namespace

double support_margin(const fem::RingStructure& structure, double outside_radius) {
  double margin = least_margin;
  for (const auto& cylinders : structure.drawing(outside_radius).cylinders)
    margin = std::max(margin, cylinders.circle_radius + cylinders.diameter / 2 - outside_radius + 1 * units::mm);
  return margin;
}

std::string held_arc(const DrawingPage& page, double radius, double first, double reach) {
  return drawn_arc(page, radius, first - reach, first + reach, "stroke=\"#D55E00\" stroke-width=\"3.5\"");
}

std::string drawn_supports(const DrawingPage& page, const fem::RingStructure& structure, double outside_radius,
                           double first, double reach) {
  if (structure.body(outside_radius).held == fem::HeldSurface::outside)
    return held_arc(page, outside_radius, first, reach);
  const auto drawing = structure.drawing(outside_radius);
  std::string svg;
  if (drawing.teeth) svg += outside_teeth(page, *drawing.teeth, outside_radius, first, reach);
  if (drawing.bore == fem::RingDrawing::Bore::around_outside)
    svg += drawn_arc(page, outside_radius, first - reach, first + reach,
                     "stroke=\"#D55E00\" stroke-width=\"1.5\" stroke-dasharray=\"6 3\"");
  for (const auto& cylinders : drawing.cylinders)
    for (const double own : cylinders.angles) {
      const double angle = std::remainder(own, 2 * std::numbers::pi) + first;
      if (std::abs(angle - first) > reach) continue;
      svg += drawn_circle(page, polar(cylinders.circle_radius, angle), cylinders.diameter / 2, support_style);
    }
  return svg;
}

}  // namespace annulus::app
