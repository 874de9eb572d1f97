#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace annulus::app {

/// A face of a body in parallel projection, by its corners in page axes (to the right, upwards, to the eye), mm.
struct Facet {
  std::array<Eigen::Vector3d, 4> corners;
  std::string fill;
  [[nodiscard]] Eigen::Vector3d normal() const { return (corners[2] - corners[0]).cross(corners[3] - corners[1]); }
  [[nodiscard]] double depth() const { return (corners[0] + corners[1] + corners[2] + corners[3]).z() / 4; }
};

/// Rows: the page axes when a ring is seen from inside, looking outwards and a little upwards, so that teeth, sleeve
/// and the held face below all show. Its contact lies in the direction of x.
[[nodiscard]] Eigen::Matrix3d eye_axes();

/// Facets and lines on a grid of a hundredth of a millimetre, as an <svg> document. Neighbours in the list with one
/// fill become one path. `edge`: colour of the edges, empty: that of the fill; `edge_width`: part of the width.
struct FacetPicture {
  std::string label;  ///< what those hear who cannot see it
  std::vector<Facet> facets{};
  std::vector<std::array<Eigen::Vector3d, 2>> lines{};  ///< over them
  std::string edge{};
  double edge_width = 0;
};
[[nodiscard]] std::string to_svg(const FacetPicture& picture);
/// From far to near.
void sort_by_depth(std::vector<Facet>& facets);

}  // namespace annulus::app
