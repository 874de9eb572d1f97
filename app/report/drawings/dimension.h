#pragma once

#include <Eigen/Core>
#include <string>

/// Dimension lines and scale bars, all places in page units (one of which is about a pixel).
namespace annulus::app {

/// "663.6", "0.0412": m as millimetres to a tenth of a micrometre.
[[nodiscard]] std::string mm_text(double length);

/// A dimension line (ISO 129): parallel to the line between two points, `offset` to the left of it on the page as one
/// walks, with extension lines, arrow heads and the text along it. Where the text is longer than the line it stands
/// behind the second point.
[[nodiscard]] std::string dimension(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double offset,
                                    const std::string& text);

/// A bar of a round length, no longer than `longest`, with its left end at the place and its length beneath.
[[nodiscard]] std::string scale_bar(const Eigen::Vector2d& left, double units_per_m, double longest);

}  // namespace annulus::app
