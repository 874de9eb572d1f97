#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace annulus::app {

inline constexpr const char* planet_fill = "#cfe3f2";
inline constexpr const char* wheel_fill = "#f7dcc4";
inline constexpr const char* sun_fill = "#e3ecd9";
inline constexpr const char* held_colour = "#D55E00";

/// Page coordinates of a drawing to scale: the line of centres upright, the planet above the sun, the ring above the
/// planet. The x axis of the gears points up the page, their y axis to the left, so that counter-clockwise stays so and
/// turns by minus the angle in SVG.
struct DrawingPage {
  double scale = 1;       ///< page units per m
  double x0 = 0, y0 = 0;  ///< of the origin

  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& point) const {
    return {x0 - scale * point.y(), y0 - scale * point.x()};
  }
  /// "12.34 -5.60" for paths.
  [[nodiscard]] std::string text(const Eigen::Vector2d& point) const;
};

/// m, of polar coordinates.
[[nodiscard]] Eigen::Vector2d polar(double radius, double angle);
/// "M1 2L3 4..." through points of the gears' plane.
[[nodiscard]] std::string path_through(const DrawingPage& page, const std::vector<Eigen::Vector2d>& points);

/// An arc or circle about a centre as a thin line; `style`: attributes.
[[nodiscard]] std::string drawn_arc(const DrawingPage& page, double radius, double from, double to, const char* style);
[[nodiscard]] std::string drawn_circle(const DrawingPage& page, const Eigen::Vector2d& centre, double radius,
                                       const std::string& style);

}  // namespace annulus::app
