#include "app/report/plot/colour_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace annulus::app {

namespace {

using Rgb = std::array<double, 3>;

// ColorBrewer's YlGnBu without its palest step (Harrower and Brewer): what carries little stays pale, also without
// colour vision.
constexpr std::array<Rgb, 8> one_way = {{{237, 248, 177},
                                         {199, 233, 180},
                                         {127, 205, 187},
                                         {65, 182, 196},
                                         {29, 145, 192},
                                         {34, 94, 168},
                                         {37, 52, 148},
                                         {8, 29, 88}}};
constexpr std::array<Rgb, 5> both_ways = {
    {{0, 84, 140}, {110, 170, 210}, {247, 247, 247}, {240, 160, 100}, {180, 70, 0}}};
template <std::size_t N>
std::string mix(const std::array<Rgb, N>& scale, double at) {
  const double place = std::clamp(at, 0.0, 1.0) * (N - 1);
  const auto low = std::min(static_cast<std::size_t>(place), N - 2);
  const double t = place - static_cast<double>(low);
  std::array<int, 3> c{};
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = static_cast<int>(std::lround((1 - t) * scale[low][i] + t * scale[low + 1][i]));
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

}  // namespace

std::string one_way_colour(double at) { return mix(one_way, at); }
std::string both_ways_colour(double at) { return mix(both_ways, at); }

int colour_level(double at) {
  return static_cast<int>(std::clamp(at * colour_levels, 0.0, static_cast<double>(colour_levels - 1)));
}
std::string level_colour(int level) { return one_way_colour(static_cast<double>(level) / (colour_levels - 1)); }

}  // namespace annulus::app
