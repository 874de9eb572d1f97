#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/report/plot/ticks.h"

namespace annulus::app {

struct Series {
  enum class Style { line, dots, bars };
  std::string label{};
  std::vector<double> x{}, y{};
  std::vector<double> low{}, high{};  ///< a shaded band between them, when given
  std::size_t colour = 0;             ///< index into the palette
  Style style = Style::line;
  bool dashed = false;
  double size = 4;  ///< of dots
};

/// A word in the plot, ending above a point.
struct Note {
  double x = 0, y = 0;
  std::string text{};
};

struct Plot {
  std::string title{};
  std::string x_label{}, y_label{};  ///< with units
  std::optional<Range> x_range{}, y_range{};
  bool x_log = false;  ///< all x are above zero
  bool y_log = false;  ///< values not above zero are not drawn
  std::vector<Series> series{};
  std::vector<std::pair<double, std::string>> levels{};  ///< horizontal reference lines
  std::vector<Note> notes{};
  bool legend = false;
  int width = 430, height = 270;
};

/// An <svg> element that scales with its container and needs nothing from outside. Values that are not finite break a
/// line; long series are reduced to the smallest and largest value of each pixel column, so that no peak is lost.
[[nodiscard]] std::string to_svg(const Plot& plot);

}  // namespace annulus::app
