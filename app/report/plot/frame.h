#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "app/report/plot/ticks.h"

/// What plots and maps have in common.
namespace annulus::app {

/// Page coordinates of the data rectangle.
struct Frame {
  double left, right, top, bottom;
  Range x, y;
  bool x_log = false, y_log = false;  ///< logarithmic: both ends of the range are above zero
  [[nodiscard]] double at_x(double v) const { return left + part(v, x, x_log) * (right - left); }
  [[nodiscard]] double at_y(double v) const { return bottom - part(v, y, y_log) * (bottom - top); }
  [[nodiscard]] static double part(double v, const Range& range, bool log) {
    return log ? std::log(v / range.low) / std::log(range.high / range.low)
               : (v - range.low) / (range.high - range.low);
  }
};

/// Grid, ticks and labels around a frame; about `y_ticks` ticks upright, as many as fit when absent, 0 for no labels.
[[nodiscard]] std::string axes(const Frame& frame, const std::string& x_label, const std::string& y_label,
                               std::optional<int> y_ticks = {});

/// The upright part of `axes` alone, with the frame.
[[nodiscard]] std::string y_axis(const Frame& frame, const std::string& y_label, std::optional<int> y_ticks = {});

/// The opening tag with size and font, and the title when there is one. `label`: what those hear who cannot see it;
/// absent: the title.
[[nodiscard]] std::string open_svg(const std::string& title, int width, int height, double title_left,
                                   const std::string& label = {});

}  // namespace annulus::app
