#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "app/report/text/svg.h"

namespace annulus::app {

inline constexpr const char* planet_fill = "#cfe3f2";
inline constexpr const char* wheel_fill = "#f7dcc4";
inline constexpr const char* sun_fill = "#e3ecd9";
inline constexpr const char* held_colour = "#D55E00";

/// m, of polar coordinates.
[[nodiscard]] Eigen::Vector2d polar(double radius, double angle);

/// Page coordinates of a drawing to scale. The usual one has the line of centres upright, the planet above the sun, the
/// ring above the planet: the x axis of the gears points up the page, their y axis to the left, so that
/// counter-clockwise stays so and turns by minus the angle in SVG.
struct DrawingPage {
  enum class Up { x, y };  ///< y: x points to the right
  double scale = 1;        ///< page units per m
  svg::Point origin{0, 0};
  Up up = Up::x;

  [[nodiscard]] svg::Point at(const Eigen::Vector2d& point) const;
  /// "M1 2L3 4..." through points, m.
  [[nodiscard]] std::string through(const std::vector<Eigen::Vector2d>& points) const;

  /// Lines as thin whatever the size of the drawing.
  [[nodiscard]] std::string line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const std::string& style) const;
  [[nodiscard]] std::string circle(const Eigen::Vector2d& centre, double radius, const std::string& style) const;
  /// About the origin.
  [[nodiscard]] std::string arc(double radius, double from, double to, const std::string& style) const;
};

}  // namespace annulus::app
