#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/report/plot/ticks.h"

/// What reports plot: curves, bars, samples and maps. Each becomes the marks of a chart (chart.h), which is drawn.
namespace annulus::app {

struct Series {
  enum class Style { line, dots, bars };
  std::string label{};
  std::vector<double> x{}, y{};       ///< values that are not finite break a line
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

/// Horizontal bars from a zero line, each with its name.
struct BarChart {
  struct Bar {
    std::string label;
    double value = 0;
    std::size_t colour = 0;           ///< index into the palette
    std::string note{};               ///< behind the bar; empty: none
    double error = 0;                 ///< drawn as a whisker to either side, when it is above zero and known
    std::optional<Range> spread{};    ///< drawn as a whisker in its place
    std::optional<double> nominal{};  ///< drawn as a diamond
  };
  std::string title{}, x_label{};
  std::vector<Bar> bars{};
  double reach = 0;        ///< largest amount on the axis; 0: that of the bars
  bool two_sided = false;  ///< the zero line in the middle, whatever the signs
  int width = 430;
  int label_width = 130;
  int row_height = 16;
};

/// Samples of one thing, drawn as a column: every sample as a dot, a box from quartile to quartile with the median,
/// whiskers from 5 to 95 %, and beside it a known value with its error bar.
struct SpreadColumn {
  std::string label{};
  std::size_t colour = 0;
  std::vector<double> values{};  ///< finite ones are drawn
  double q05 = 0, q25 = 0, median = 0, q75 = 0, q95 = 0;
  double nominal = 0, nominal_error = 0;
};

struct SpreadPlot {
  std::string title{}, y_label{};
  std::vector<SpreadColumn> columns{};
  int width = 430, height = 290;
};

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

}  // namespace annulus::app
