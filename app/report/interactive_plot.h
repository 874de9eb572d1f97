#pragma once

#include <string>

#include "app/report/svg_bars.h"
#include "app/report/svg_map.h"
#include "app/report/svg_plot.h"
#include "app/report/svg_spread.h"

namespace annulus::app {

/// The picture of a plot with its numbers beside it, so that page_scripts can make it interactive. Long series are
/// reduced to the smallest and largest values of a few thousand steps.
[[nodiscard]] std::string plot_html(const Plot& plot);
[[nodiscard]] std::string plot_html(const BarChart& chart);
[[nodiscard]] std::string plot_html(const ColourMap& map);
[[nodiscard]] std::string plot_html(const SpreadPlot& plot);

}  // namespace annulus::app
