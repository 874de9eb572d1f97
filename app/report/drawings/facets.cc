#include "app/report/drawings/facets.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/report/text/svg.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// A path of polygons and lines by whole differences: a third of the size of absolute coordinates.
class GridPath {
 public:
  template <std::size_t N>
  void add(const std::array<Eigen::Vector3d, N>& points) {
    char command = 'm';
    for (const auto& p : points) {
      const std::array<long, 2> to = {std::lround(100 * p.x()), std::lround(-100 * p.y())};
      const long x = to[0] - at_[0], y = to[1] - at_[1];
      fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{}{}{}{}"), command, x, y < 0 ? "" : " ", y);
      at_ = to;
      if (command == 'm') start_ = to;
      command = 'l';
    }
    if (N < 3) return;
    text_ += 'z';
    at_ = start_;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::array<long, 2> at_{}, start_{};  // paths start at the origin
};

}  // namespace

Eigen::Matrix3d eye_axes() {
  const double azimuth = -32 * units::deg, elevation = -24 * units::deg;
  const Eigen::Vector3d towards(-std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(towards).normalized();
  Eigen::Matrix3d axes;
  axes << right.transpose(), towards.cross(right).transpose(), towards.transpose();
  return axes;
}

void sort_by_depth(std::vector<Facet>& facets) {
  std::stable_sort(facets.begin(), facets.end(), [](const auto& a, const auto& b) { return a.depth() < b.depth(); });
}

std::string to_svg(const FacetPicture& picture) {
  Eigen::AlignedBox2d box;
  for (const auto& facet : picture.facets)
    for (const auto& p : facet.corners) box.extend(Eigen::Vector2d(p.x(), -p.y()));
  const double margin = 0.02 * box.sizes().maxCoeff();
  const Eigen::Vector2d low = box.min().array() - margin, size = box.sizes().array() + 2 * margin;
  std::string paths;
  for (std::size_t i = 0; i < picture.facets.size();) {
    const auto& fill = picture.facets[i].fill;
    GridPath path;
    for (; i < picture.facets.size() && picture.facets[i].fill == fill; ++i) path.add(picture.facets[i].corners);
    const auto& edge = picture.edge.empty() ? fill : picture.edge;
    paths += svg::path(path.text(), fmt::format(R"(fill="{}" stroke="{}")", fill, edge));
  }
  if (!picture.lines.empty()) {
    GridPath path;
    for (const auto& line : picture.lines) path.add(line);
    paths += svg::path(
        path.text(),
        fmt::format(R"(fill="none" stroke="#555" stroke-opacity="0.55" stroke-width="{:.3g}")", 0.16 * size.x()));
  }
  const auto style = fmt::format(R"-(transform="scale(.01)" stroke-width="{:.3g}" stroke-linejoin="round")-",
                                 100 * picture.edge_width * size.x());
  return svg::picture(picture.label, low, size, svg::group(style, paths));
}

}  // namespace annulus::app
