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

std::string turned(double angle) { return fmt::format("rotate({:.4f})", -angle / units::deg); }

}  // namespace

std::string gear_defs(const DrawingPage& page, const DrawnGear& drawn) {
  const auto& gear = drawn.gear;
  const DrawingPage own{page.scale};
  const auto outline = geometry::tooth_outline(geometry::ToothProfile(gear), outline_error / page.scale);
  const bool internal = gear.kind() == geometry::GearKind::internal;
  // The body as far as the teeth overlap it.
  const double root = gear.root_radius() * page.scale;
  const double other = (internal ? drawn.outside_radius : drawn.inner_radius) * page.scale;
  std::string svg = fmt::format(
      "<defs><g id=\"tooth-{0}\"><path d=\"{1}L{2}L{3}Z\" fill=\"{4}\"/><path id=\"outline-{0}\" d=\"{1}\" "
      "fill=\"none\" stroke=\"#2c3a48\" stroke-width=\"0.7\"/></g>",
      drawn.id, path_through(own, outline), own.text(polar(filled_to(drawn), gear.pitch_angle() / 2)),
      own.text(polar(filled_to(drawn), -gear.pitch_angle() / 2)), drawn.fill);
  svg += fmt::format("<g id=\"gear-{}\"><path d=\"{}{}\" fill=\"{}\" fill-rule=\"evenodd\"/>", drawn.id,
                     circle_path(root), other > 0 ? circle_path(other) : "", drawn.fill);
  if (other > 0)
    svg += fmt::format("<circle r=\"{:.2f}\" fill=\"none\" stroke=\"#2c3a48\" stroke-width=\"0.7\"/>", other);
  for (int i = 0; i < gear.teeth(); ++i)
    svg += fmt::format("<use href=\"#tooth-{}\" transform=\"{}\"/>", drawn.id, turned(i * gear.pitch_angle()));
  return svg + "</g></defs>";
}

std::string placed_gear(const DrawingPage& page, const DrawnGear& drawn, const Eigen::Vector2d& centre, double angle) {
  const Eigen::Vector2d c = page.at(centre);
  return fmt::format("<use href=\"#gear-{}\" transform=\"translate({:.3f} {:.3f}) {}\"/>", drawn.id, c.x(), c.y(),
                     turned(angle));
}

}  // namespace annulus::app
