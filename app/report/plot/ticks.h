#pragma once

#include <string>
#include <vector>

/// What all plots share: colours, round numbers and ranges.
namespace annulus::app {

/// The palette of [OkabeIto2008], continued with the muted one of [Tol2021], safe for colour-blind readers; the index
/// wraps around.
[[nodiscard]] const char* palette(std::size_t index);

/// The largest 1, 2 or 5 times a power of ten that is not above a value.
[[nodiscard]] double round_below(double value);
/// A finite value with so many digits.
[[nodiscard]] double significant(double value, int digits);
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

}  // namespace annulus::app
