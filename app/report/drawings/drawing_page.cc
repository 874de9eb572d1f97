#include "app/report/drawings/drawing_page.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace annulus::app {

namespace {

const std::string thin = R"( vector-effect="non-scaling-stroke")";

}  // namespace

Eigen::Vector2d polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

svg::Point DrawingPage::at(const Eigen::Vector2d& point) const {
  return origin + scale * (up == Up::x ? svg::Point(-point.y(), -point.x()) : svg::Point(point.x(), -point.y()));
}

std::string DrawingPage::through(const std::vector<Eigen::Vector2d>& points) const {
  std::vector<svg::Point> list;
  list.reserve(points.size());
  for (const auto& point : points) list.push_back(at(point));
  return svg::through(list);
}

std::string DrawingPage::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const std::string& style) const {
  return svg::line(at(a), at(b), style + thin);
}

std::string DrawingPage::circle(const Eigen::Vector2d& centre, double radius, const std::string& style) const {
  return svg::circle(at(centre), scale * radius, style + thin);
}

std::string DrawingPage::arc(double radius, double from, double to, const std::string& style) const {
  constexpr double step = 2 * units::deg;  // a tenth of a per mille of the radius between chord and arc
  const int pieces = std::max(48, static_cast<int>(std::abs(to - from) / step));
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= pieces; ++i) points.push_back(polar(radius, from + (to - from) * i / pieces));
  return svg::path(through(points), R"(fill="none" )" + style + thin);
}

}  // namespace annulus::app
