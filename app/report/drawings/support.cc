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

/// Outline of spline teeth with their flank angle, as wide as their spaces; a sketch, for their height is not an input.
std::string spline_teeth(const DrawingPage& page, const fem::SplineHeld& spline, double radius, double first,
                         double reach) {
  std::string d;
  const double quarter = std::numbers::pi / 2 / spline.teeth;
  const double height = std::min(quarter * radius, least_margin - 1 * units::mm);
  const double top = quarter - height * std::tan(spline.flank_angle) / radius;
  for (const double own : fem::equal_angles(spline.teeth, spline.first_tooth_angle)) {
    const double angle = std::remainder(own, 2 * std::numbers::pi) + first;
    if (std::abs(angle - first) > reach) continue;
    d += path_through(page, {polar(radius, angle - quarter), polar(radius + height, angle - top),
                             polar(radius + height, angle + top), polar(radius, angle + quarter)}) +
         "Z";
  }
  return fmt::format("<path d=\"{}\" {} vector-effect=\"non-scaling-stroke\"/>", d, support_style);
}

}  // namespace

double support_margin(const fem::RingStructure& structure) {
  const auto* pins = std::get_if<fem::PinHeld>(&structure);
  return pins ? std::max(least_margin, pins->pin_diameter / 2 + 1 * units::mm) : least_margin;
}

std::string held_arc(const DrawingPage& page, double radius, double first, double reach) {
  return drawn_arc(page, radius, first - reach, first + reach, "stroke=\"#D55E00\" stroke-width=\"3.5\"");
}

std::string drawn_supports(const DrawingPage& page, const fem::RingStructure& structure, double outside_radius,
                           double first, double reach) {
  if (std::holds_alternative<fem::OutsideHeld>(structure)) return held_arc(page, outside_radius, first, reach);
  if (const auto* spline = std::get_if<fem::SplineHeld>(&structure))
    return spline_teeth(page, *spline, outside_radius, first, reach);
  const auto* pins = std::get_if<fem::PinHeld>(&structure);
  if (!pins) return "";
  std::string svg;
  if (pins->housing_clearance)
    svg += drawn_arc(page, outside_radius, first - reach, first + reach,
                     "stroke=\"#D55E00\" stroke-width=\"1.5\" stroke-dasharray=\"6 3\"");
  for (const double own : pins->angles) {
    const double angle = std::remainder(own, 2 * std::numbers::pi) + first;
    if (std::abs(angle - first) > reach) continue;
    svg += drawn_circle(page, polar(outside_radius, angle), pins->pin_diameter / 2, support_style);
  }
  return svg;
}

}  // namespace annulus::app
