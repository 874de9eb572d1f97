#pragma once

#include <string>
#include <vector>

#include "app/report/plot/curves.h"

namespace annulus::app {

/// Horizontal bars from a zero line, each with its name.
struct BarChart {
  struct Bar {
    std::string label;
    double value = 0;
    std::size_t colour = 0;  ///< index into the palette
    std::string note{};      ///< behind the bar; empty: none
    double error = 0;        ///< drawn as a whisker to either side, when it is above zero and known
  };
  std::string title{}, x_label{};
  std::vector<Bar> bars{};
  double reach = 0;        ///< largest amount on the axis; 0: that of the bars
  bool two_sided = false;  ///< the zero line in the middle, whatever the signs
  int width = 430;
  int label_width = 130;
  int row_height = 16;
};

/// What its axis spans.
[[nodiscard]] Range bar_range(const BarChart& chart);

/// An <svg> element that scales with its container and needs nothing from outside.
[[nodiscard]] std::string to_svg(const BarChart& chart);

}  // namespace annulus::app
