#pragma once

#include <string>

namespace annulus::app {

/// A scale has so many steps of colour; odd: the middle one is the neutral colour of a scale both ways.
inline constexpr int colour_levels = 33;

/// "#c7e9b4", of a place in [0, 1] on a scale from nothing to much, and on one from below zero to above.
[[nodiscard]] std::string one_way_colour(double at);
[[nodiscard]] std::string both_ways_colour(double at);

/// The step of a place in [0, 1], beyond it the last ones, and the colour of a step of the scale from nothing to much.
[[nodiscard]] int colour_level(double at);
[[nodiscard]] std::string level_colour(int level);

}  // namespace annulus::app
