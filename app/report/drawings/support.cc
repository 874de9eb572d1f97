#include "app/report/drawings/support.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double least_margin = 6 * units::mm, clearance = 1 * units::mm;
constexpr const char* support_style = R"(fill="#D55E00" fill-opacity="0.75" stroke="#7a3600" stroke-width="0.8")";

/// The outline of a tooth on the outside with its flank angle, as wide as its space; a sketch: no input says its
/// height.
std::vector<Eigen::Vector2d> tooth(const fem::RingDrawing::OutsideTeeth& teeth, double radius, double angle) {
  const double quarter = std::numbers::pi / 2 / static_cast<double>(teeth.angles.size());
  const double height = std::min(quarter * radius, least_margin - clearance);
  const double top = quarter - height * std::tan(teeth.flank_angle) / radius;
  return {polar(radius, angle - quarter), polar(radius + height, angle - top), polar(radius + height, angle + top),
          polar(radius, angle + quarter)};
}

}  // namespace

double support_margin(const fem::RingStructure& structure, double outside_radius) {
  double margin = least_margin;
  for (const auto& cylinders : structure.drawing(outside_radius).cylinders)
    margin = std::max(margin, cylinders.circle_radius + cylinders.diameter / 2 - outside_radius + clearance);
  return margin;
}

std::string held_arc(const DrawingPage& page, double radius, double first, double reach) {
  return page.arc(radius, first - reach, first + reach, R"(stroke="#D55E00" stroke-width="3.5")");
}

std::string drawn_supports(const DrawingPage& page, const fem::RingStructure& structure, double outside_radius,
                           double first, double reach) {
  if (structure.body(outside_radius).held == fem::HeldSurface::outside)
    return held_arc(page, outside_radius, first, reach);
  const auto drawing = structure.drawing(outside_radius);
  /// Polar angles of those within reach.
  const auto seen = [&](const std::vector<double>& angles) {
    std::vector<double> list;
    for (const double own : angles)
      if (const double turn = std::remainder(own, 2 * std::numbers::pi); std::abs(turn) <= reach)
        list.push_back(turn + first);
    return list;
  };
  std::string text;
  if (drawing.teeth) {
    std::string d;
    for (const double angle : seen(drawing.teeth->angles))
      d += page.through(tooth(*drawing.teeth, outside_radius, angle)) + "Z";
    text += svg::path(d, support_style + std::string(R"( vector-effect="non-scaling-stroke")"));
  }
  if (drawing.bore == fem::RingDrawing::Bore::around_outside)
    text += page.arc(outside_radius, first - reach, first + reach,
                     R"(stroke="#D55E00" stroke-width="1.5" stroke-dasharray="6 3")");
  for (const auto& cylinders : drawing.cylinders)
    for (const double angle : seen(cylinders.angles))
      text += page.circle(polar(cylinders.circle_radius, angle), cylinders.diameter / 2, support_style);
  return text;
}

}  // namespace annulus::app
