#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/report/plot/curves.h"

namespace annulus::app {

/// Rectangles coloured by a value over two axes, in panels side by side that share the upright axis and the colours.
struct ColourMap {
  struct Cell {
    Range x, y;
    std::optional<double> value{};  ///< absent: grey, `grey` says what that means
  };
  struct Panel {
    std::string title{};
    Range x_range{};
    std::vector<Cell> cells{};
    std::vector<std::pair<double, double>> line{};  ///< drawn over the cells; a point that is not finite breaks it
  };
  std::string title{};
  std::string x_label{}, y_label{}, value_label{};  ///< with units
  Range y_range{};
  std::optional<int> y_ticks{};  ///< about so many; absent: as many as fit
  Range values{};      ///< of the colour scale: from pale to dark, or both ways from zero when it reaches below zero
  std::string grey{};  ///< "lifted off"; empty: no such cells
  std::vector<Panel> panels{};
  int width = 900, height = 320;
};

/// Colours in steps from the lower to the upper end of a range, beyond it the last ones.
struct ColourScale {
  Range range{};
  std::vector<std::string> colours{};  ///< "#c7e9b4"
  std::string no_value{};
};
[[nodiscard]] ColourScale colour_scale(const ColourMap& map);

/// An <svg> element like those of `Plot`. Neighbours of the same colour become one rectangle.
[[nodiscard]] std::string to_svg(const ColourMap& map);

}  // namespace annulus::app
