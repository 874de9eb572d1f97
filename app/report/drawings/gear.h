#pragma once

#include <string>

#include "app/report/drawings/drawing_page.h"
#include "geometry/profile.h"

namespace annulus::app {

/// A gear of a drawing: one tooth outline, written once and used again for every tooth.
struct DrawnGear {
  geometry::Gear gear;
  std::string id;  ///< makes the identifiers unique within a page
  const char* fill = wheel_fill;
  double inner_radius = 0;    ///< m: bore of an external gear; 0: none
  double outside_radius = 0;  ///< m: of the rim of an internal gear
};

/// <defs> of the tooth and of the whole gear, its tooth 0 upright, its axis at the origin.
[[nodiscard]] std::string gear_defs(const DrawingPage& page, const DrawnGear& gear);
/// The gear where it stands, turned counter-clockwise by `angle`.
[[nodiscard]] std::string placed_gear(const DrawingPage& page, const DrawnGear& gear, const Eigen::Vector2d& centre,
                                      double angle);

inline constexpr const char* base_circle_style =
    R"(fill="none" stroke="#0072B2" stroke-width="1" stroke-dasharray="5 3")";
inline constexpr const char* pitch_circle_style =
    R"(fill="none" stroke="#555" stroke-width="0.8" stroke-dasharray="12 3 2 3")";
inline constexpr const char* outline_style = R"(fill="none" stroke="#2c3a48" stroke-width="0.7")";

}  // namespace annulus::app
