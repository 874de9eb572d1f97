#pragma once

#include <string>
#include <vector>

namespace annulus::app {

/// A scale has so many steps of colour; odd: the middle one is the neutral colour of a scale both ways.
inline constexpr int colour_levels = 33;

/// "#c7e9b4" of every step: from nothing to much, or from below zero to above.
enum class Ways { one, both };
[[nodiscard]] std::vector<std::string> scale_colours(Ways ways);

/// The step of a place in [0, 1], beyond it the last ones.
[[nodiscard]] std::size_t colour_level(double at);

}  // namespace annulus::app
