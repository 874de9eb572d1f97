#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "app/report/plot/chart.h"

namespace annulus::app {

std::vector<std::size_t> reduced_points(const Mark& mark, const std::vector<double>& y, double columns,
                                        const std::function<double(std::size_t)>& column_of) {
  const auto& x = mark.x;
  std::vector<std::size_t> points(x.size());
  std::iota(points.begin(), points.end(), 0);
  if (static_cast<double>(x.size()) <= 4 * columns || !std::is_sorted(x.begin(), x.end())) return points;
  points.clear();
  for (std::size_t begin = 0, end = 0; begin < x.size(); begin = end) {
    const double column = column_of(begin);
    std::size_t low = begin, high = begin;
    for (end = begin; end == begin || (end < x.size() && column_of(end) == column); ++end) {
      if (y[end] < y[low]) low = end;
      if (y[end] > y[high]) high = end;
    }
    for (const std::size_t i : std::set<std::size_t>{begin, low, high, end - 1}) points.push_back(i);
  }
  return points;
}

std::vector<std::size_t> distinct_dots(const Mark& mark) {
  constexpr std::size_t few = 4000;
  std::vector<std::size_t> points;
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < mark.x.size(); ++i) {
    if (!std::isfinite(mark.x[i]) || !std::isfinite(mark.y[i])) continue;
    points.push_back(i);
    box.extend(Eigen::Vector2d(mark.x[i], mark.y[i]));
  }
  if (points.size() <= few) return points;
  const Eigen::Array2d cells(600, 400);
  std::set<std::pair<long, long>> taken;
  std::erase_if(points, [&](std::size_t i) {
    const Eigen::Array2d from_corner = Eigen::Array2d(mark.x[i], mark.y[i]) - box.min().array();
    const Eigen::Array2d at = (box.sizes().array() > 0).select(cells * from_corner / box.sizes().array(), 0);
    return !taken.emplace(std::lround(at.x()), std::lround(at.y())).second;
  });
  return points;
}

}  // namespace annulus::app
