#include "app/report/drawings/dimension.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/report/text/xml.h"
#include "app/scene/scene_value.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double arrow_length = 8, arrow_half_width = 2.2;

/// A filled arrow head with its tip at a place, pointing along a unit vector.
std::string arrow(const Eigen::Vector2d& tip, const Eigen::Vector2d& along) {
  const Eigen::Vector2d side(-along.y(), along.x()), back = tip - arrow_length * along;
  const Eigen::Vector2d a = back + arrow_half_width * side, b = back - arrow_half_width * side;
  return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z", tip.x(), tip.y(), a.x(), a.y(), b.x(), b.y());
}

std::string segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", a.x(), a.y(), b.x(), b.y());
}

}  // namespace

std::string mm_text(double length) { return to_text(std::round(length / units::um * 10) / 1e4, 9); }

std::string dimension(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double offset, const std::string& text) {
  constexpr double beyond = 4, letter = 5.8, gap = 4;
  const double length = (to - from).norm();
  const Eigen::Vector2d along = length > 0 ? Eigen::Vector2d((to - from) / length) : Eigen::Vector2d(1, 0);
  const Eigen::Vector2d left(along.y(), -along.x());  // the page's y axis points down
  const Eigen::Vector2d a = from + offset * left, b = to + offset * left;
  const Eigen::Vector2d end = (offset < 0 ? -beyond : beyond) * left;
  const double text_length = letter * static_cast<double>(text.size());
  const bool arrows_inside = length > 3 * arrow_length, text_inside = length > text_length + 2 * arrow_length;
  std::string lines, heads;
  if (offset != 0) lines = segment(from, a + end) + segment(to, b + end);
  const double tail = arrows_inside ? 0 : 2 * arrow_length, rest = text_inside ? 0 : text_length + 2 * gap;
  lines += segment(a - tail * along, b + std::max(tail, rest) * along);
  heads = arrow(a, arrows_inside ? Eigen::Vector2d(-along) : along) +
          arrow(b, arrows_inside ? along : Eigen::Vector2d(-along));
  // Readable from below or from the right.
  double turn = std::atan2(along.y(), along.x()) / units::deg;
  if (turn > 90 - 1e-6) turn -= 180;
  if (turn < -90 - 1e-6) turn += 180;
  const double angle = turn * units::deg;
  const Eigen::Vector2d above = 3.5 * Eigen::Vector2d(std::sin(angle), -std::cos(angle));
  const double behind = std::max(arrows_inside ? 0 : arrow_length, 0.0) + gap + text_length / 2;
  const Eigen::Vector2d at =
      (text_inside ? Eigen::Vector2d(0.5 * (a + b)) : Eigen::Vector2d(b + behind * along)) + above;
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"#333\" stroke-width=\"0.8\"/><path d=\"{}\" fill=\"#333\"/><text "
      "transform=\"translate({:.1f} {:.1f}) rotate({:.2f})\" text-anchor=\"middle\" paint-order=\"stroke\" "
      "stroke=\"#fff\" stroke-width=\"2.5\">{}</text>",
      lines, heads, at.x(), at.y(), turn, escape(text));
}

std::string scale_bar(const Eigen::Vector2d& left, double units_per_m, double longest) {
  const double most = longest / units_per_m / units::mm;
  const double decade = std::pow(10.0, std::floor(std::log10(most)));
  const double mm = decade * (most >= 5 * decade ? 5 : most >= 2 * decade ? 2 : 1);
  const double width = mm * units::mm * units_per_m;
  return fmt::format(
      "<path d=\"M{0:.2f} {1:.1f}v-7m0 3.5h{2:.2f}m0 -3.5v7\" fill=\"none\" stroke=\"#333\" "
      "stroke-width=\"1.4\"/><text "
      "x=\"{0:.1f}\" y=\"{3:.1f}\">{4} mm</text>",
      left.x(), left.y(), width, left.y() + 13, to_text(mm, 6));
}

}  // namespace annulus::app
