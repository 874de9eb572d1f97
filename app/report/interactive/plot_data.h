#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// What the scripts of a page (page.js) are told of a plot.
namespace annulus::app {

/// Six digits, which are finer than any screen; null for what is not finite.
[[nodiscard]] nlohmann::json plot_number(double value);
[[nodiscard]] nlohmann::json plot_numbers(const std::vector<double>& values);

/// The picture with its data beside it.
[[nodiscard]] std::string with_plot_data(const std::string& svg, const nlohmann::json& data);

}  // namespace annulus::app
