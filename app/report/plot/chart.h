#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/report/plot/plots.h"

/// The one description of a plot, from which its picture and its interactive twin are made.
namespace annulus::app {

/// Something drawn at points in data coordinates; a point that is not finite breaks a line.
struct Mark {
  enum class Kind { line, dots, diamonds, stems, shape };  ///< a shape: closed and filled
  Kind kind = Kind::line;
  std::string label{};  ///< shown at the pointer; empty: nothing is shown
  std::string colour{};
  std::vector<double> x{}, y{};
  std::vector<double> low{}, high{};  ///< a shaded band around a line
  double size = 1.6;                  ///< width of lines, diameter of dots, page units
  double opacity = 1;                 ///< of dots and of the inside of a shape
  std::vector<int> dash{};
  double error = 0;       ///< of its only value
  std::size_t group = 0;  ///< marks of a group are hidden together
  bool in_legend = false;
};

struct Axis {
  std::string label{};
  Range range{};  ///< from the left or the bottom
  bool log = false;
  std::vector<std::string> names{};  ///< in place of ticks, name i at i + 1/2
  std::optional<int> ticks{};        ///< about so many; absent: as many as fit
  double gap = 6;                    ///< of an upright one: page units between its labels and the panel
};

/// A text beside a point: to its left when `shift` is negative, else to its right.
struct Words {
  double x = 0, y = 0;
  std::string text{}, colour{};
  double shift = 0, rise = 0;  ///< page units
};

struct Panel {
  std::string title{};
  Axis x{}, y{};
  std::vector<Mark> marks{};
  std::vector<ColourMap::Cell> cells{};
  std::vector<Words> words{};
};

/// Colours in steps from the lower to the upper end of a range, beyond it the last ones.
struct ColourScale {
  std::string label{};
  Range range{};
  std::vector<std::string> colours{};  ///< "#c7e9b4"
  std::string grey{};                  ///< meaning of cells without a value
  /// The colour of a value.
  [[nodiscard]] const std::string& of(const std::optional<double>& value) const;
};

struct Chart {
  Chart(const Plot& plot);
  Chart(const BarChart& bars);
  Chart(const SpreadPlot& spread);
  Chart(const ColourMap& map);

  std::string title{};
  std::string label{};  ///< what those hear who cannot see it; empty: the title
  double width = 0, height = 0;
  double left = 62, right = 12, below = 42;  ///< margins around the panels
  std::vector<Panel> panels{};               ///< side by side
  bool legend = false;
  std::optional<ColourScale> scale{};
};

/// An <svg> element that scales with its container and needs nothing from outside. Long series are reduced to the
/// smallest and largest value of each pixel column, so that no peak is lost.
[[nodiscard]] std::string to_svg(const Chart& chart);
/// For page.js, with the options of Chart.js for every mark. Long series are reduced to the smallest and largest values
/// of a thousand steps.
[[nodiscard]] nlohmann::json plot_data(const Chart& chart);

/// Six digits, which are finer than any screen; null for what is not finite.
[[nodiscard]] nlohmann::json plot_number(double value);

/// Of a long series in ascending x, the first, smallest, largest and last point of each of its `columns`, which are
/// numbered by `column_of` a point; of others all points.
[[nodiscard]] std::vector<std::size_t> reduced_points(const Mark& mark, const std::vector<double>& y, double columns,
                                                      const std::function<double(std::size_t)>& column_of);
/// Distinct dots: of several thousand, one in each cell of a fine grid over them.
[[nodiscard]] std::vector<std::size_t> distinct_dots(const Mark& mark);

}  // namespace annulus::app
