#include "app/report/plot/colour_scale.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>

namespace annulus::app {

std::vector<std::string> scale_colours(Ways ways) {
  // ColorBrewer's YlGnBu without its palest step [HarrowerBrewer2003]: what carries little stays pale, also without
  // colour vision.
  static const std::vector<Eigen::Vector3d> one_way = {{237, 248, 177}, {199, 233, 180}, {127, 205, 187},
                                                       {65, 182, 196},  {29, 145, 192},  {34, 94, 168},
                                                       {37, 52, 148},   {8, 29, 88}};
  static const std::vector<Eigen::Vector3d> both_ways = {
      {0, 84, 140}, {110, 170, 210}, {247, 247, 247}, {240, 160, 100}, {180, 70, 0}};
  const auto& corners = ways == Ways::one ? one_way : both_ways;
  std::vector<std::string> colours;
  for (int level = 0; level < colour_levels; ++level) {
    const double at = static_cast<double>(level) / (colour_levels - 1) * static_cast<double>(corners.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), corners.size() - 2);
    const double t = at - static_cast<double>(low);
    const Eigen::Vector3i c = ((1 - t) * corners[low] + t * corners[low + 1]).array().round().cast<int>();
    colours.push_back(fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]));
  }
  return colours;
}

std::size_t colour_level(double at) {
  return static_cast<std::size_t>(std::clamp(at * colour_levels, 0.0, static_cast<double>(colour_levels - 1)));
}

}  // namespace annulus::app
