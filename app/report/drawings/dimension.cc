#include "app/report/drawings/dimension.h"

#include <fmt/format.h>

#include <cmath>

#include "app/report/plot/ticks.h"
#include "app/report/text/svg.h"
#include "app/scene/scene_value.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double arrow_length = 8, arrow_half_width = 2.2;

/// A filled arrow head with its tip at a place, pointing along a unit vector.
std::string arrow(const svg::Point& tip, const svg::Point& along) {
  const svg::Point side = arrow_half_width * svg::Point(-along.y(), along.x()), back = tip - arrow_length * along;
  return svg::through({tip, back + side, back - side}) + "Z";
}

}  // namespace

std::string mm_text(double length) { return to_text(std::round(length / units::um * 10) / 1e4, 9); }

std::string dimension(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double offset, const std::string& text) {
  constexpr double beyond = 4, letter = 5.8, gap = 4;
  const double length = (to - from).norm();
  const svg::Point along = length > 0 ? svg::Point((to - from) / length) : svg::Point(1, 0);
  const svg::Point left(along.y(), -along.x());  // the page's y axis points down
  const svg::Point a = from + offset * left, b = to + offset * left;
  const svg::Point end = (offset < 0 ? -beyond : beyond) * left;
  const double text_length = letter * static_cast<double>(text.size());
  const bool arrows_inside = length > 3 * arrow_length, text_inside = length > text_length + 2 * arrow_length;
  const double tail = arrows_inside ? 0 : 2 * arrow_length, rest = text_inside ? 0 : text_length + 2 * gap;
  std::string lines = svg::through({a - tail * along, b + std::max(tail, rest) * along});
  if (offset != 0) lines += svg::through({from, a + end}) + svg::through({to, b + end});
  const svg::Point outwards = (arrows_inside ? 1 : -1) * along;
  // Readable from below or from the right.
  double turn = std::atan2(along.y(), along.x()) / units::deg;
  if (turn > 90 - 1e-6) turn -= 180;
  if (turn < -90 - 1e-6) turn += 180;
  const double angle = turn * units::deg, behind = (arrows_inside ? 0 : arrow_length) + gap + text_length / 2;
  const svg::Point above = 3.5 * svg::Point(std::sin(angle), -std::cos(angle));
  const svg::Point at = above + (text_inside ? svg::Point(0.5 * (a + b)) : svg::Point(b + behind * along));
  return svg::path(lines, R"(fill="none" stroke="#333" stroke-width="0.8")") +
         svg::path(arrow(a, -outwards) + arrow(b, outwards), R"(fill="#333")") +
         svg::words({0, 0}, text,
                    fmt::format(R"-(transform="translate({:.1f} {:.1f}) rotate({:.2f})" {} paint-order="stroke" )-"
                                R"(stroke="#fff" stroke-width="2.5")",
                                at.x(), at.y(), turn, svg::centred));
}

std::string scale_bar(const Eigen::Vector2d& left, double units_per_m, double longest) {
  const double mm = round_below(longest / units_per_m / units::mm);
  return svg::path(
             fmt::format("M{:.2f} {:.1f}v-7m0 3.5h{:.2f}m0 -3.5v7", left.x(), left.y(), mm * units::mm * units_per_m),
             R"(fill="none" stroke="#333" stroke-width="1.4")") +
         svg::words(left + svg::Point(0, 13), to_text(mm, 6) + " mm");
}

}  // namespace annulus::app
