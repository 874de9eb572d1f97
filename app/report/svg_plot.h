#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace annulus::app {

/// Okabe and Ito's palette, continued with Tol's muted one, safe for colour-blind readers; the index wraps around.
[[nodiscard]] const char* palette(std::size_t index);

/// `text` with &, <, > and " made harmless in XML and HTML.
[[nodiscard]] std::string escape(const std::string& text);

/// Round values ("nice numbers": 1, 2 or 5 times a power of ten) inside [low, high], about `count` of them.
[[nodiscard]] std::vector<double> nice_ticks(double low, double high, int count);
/// 1, 2 and 5 times powers of ten inside [low, high] for a logarithmic axis, over many decades the powers alone; the
/// ends when there are fewer than two.
[[nodiscard]] std::vector<double> log_ticks(double low, double high);
/// Tick labels with just the digits that tell neighbours apart.
[[nodiscard]] std::vector<std::string> tick_labels(const std::vector<double>& ticks);

struct Range {
  double low = 0, high = 1;
};

/// Smallest range of several data sets with a little air around, for plots that are to be compared.
class RangeFinder {
 public:
  void add(double value);
  void add(const std::vector<double>& values);
  /// Nothing added: [0, 1]. A constant: a range around it.
  [[nodiscard]] Range range(double margin = 0.06) const;

 private:
  double low_ = 0, high_ = 0;
  bool any_ = false;
};

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
