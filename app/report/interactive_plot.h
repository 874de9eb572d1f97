#pragma once

#include <string>

#include "app/report/svg_plot.h"

namespace annulus::app {

/// The picture of a plot with its numbers beside it, so that page_scripts can make it interactive. Long series are
/// reduced to the smallest and largest values of a few thousand steps.
[[nodiscard]] std::string plot_html(const Plot& plot);

}  // namespace annulus::app
