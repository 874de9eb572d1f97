#pragma once

#include <string>
#include <vector>

#include "app/report/plot/curves.h"

namespace annulus::app {

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

/// Where the parts of column `index` stand: x counts the columns.
struct ColumnPlaces {
  std::vector<double> samples{};  ///< spread, so that neighbours in the list do not fall on each other
  double box = 0, nominal = 0;
};
[[nodiscard]] ColumnPlaces places_in_column(std::size_t index, std::size_t samples);

[[nodiscard]] std::string to_svg(const SpreadPlot& plot);

}  // namespace annulus::app
