#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/report/plot/bars.h"
#include "app/report/plot/curves.h"
#include "app/report/plot/map.h"
#include "app/report/plot/spread.h"

/// The numbers of plots for the script of a page (page.js), which makes them interactive. Each stands beside the
/// picture of its plot (curves.cc, bars.cc, map.cc, spread.cc).
namespace annulus::app {

/// Long series are reduced to the smallest and largest values of a few thousand steps.
[[nodiscard]] nlohmann::json plot_data(const Plot& plot);
[[nodiscard]] nlohmann::json plot_data(const BarChart& chart);
[[nodiscard]] nlohmann::json plot_data(const ColourMap& map);
[[nodiscard]] nlohmann::json plot_data(const SpreadPlot& plot);

/// Six digits, which are finer than any screen; null for what is not finite.
[[nodiscard]] nlohmann::json plot_number(double value);
[[nodiscard]] nlohmann::json plot_numbers(const std::vector<double>& values);

/// As the content of a <script> element, which no text within it can end.
[[nodiscard]] std::string script_text(const nlohmann::json& data);

}  // namespace annulus::app
