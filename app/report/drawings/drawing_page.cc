#include "app/report/drawings/drawing_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace annulus::app {

std::string DrawingPage::text(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d p = at(point);
  return fmt::format("{:.2f} {:.2f}", p.x(), p.y());
}

Eigen::Vector2d polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

std::string path_through(const DrawingPage& page, const std::vector<Eigen::Vector2d>& points) {
  std::string d;
  for (const auto& point : points) d += (d.empty() ? "M" : "L") + page.text(point);
  return d;
}

std::string drawn_arc(const DrawingPage& page, double radius, double from, double to, const char* style) {
  constexpr double step = 2 * units::deg;  // a tenth of a per mille of the radius between chord and arc
  const int pieces = std::max(48, static_cast<int>(std::abs(to - from) / step));
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= pieces; ++i) points.push_back(polar(radius, from + (to - from) * i / pieces));
  return fmt::format("<path d=\"{}\" fill=\"none\" {} vector-effect=\"non-scaling-stroke\"/>",
                     path_through(page, points), style);
}

std::string drawn_circle(const DrawingPage& page, const Eigen::Vector2d& centre, double radius,
                         const std::string& style) {
  const Eigen::Vector2d c = page.at(centre);
  return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {} vector-effect=\"non-scaling-stroke\"/>",
                     c.x(), c.y(), page.scale * radius, style);
}

}  // namespace annulus::app
