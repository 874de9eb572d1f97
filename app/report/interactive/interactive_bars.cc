#include "app/report/interactive/plot_data.h"
#include "app/report/interactive_plot.h"

namespace annulus::app {

std::string plot_html(const BarChart& chart) {
  nlohmann::json data = {
      {"kind", "bars"}, {"title", chart.title}, {"x_label", chart.x_label}, {"bars", nlohmann::json::array()}};
  const auto range = bar_range(chart);
  data["x_range"] = {plot_number(range.low), plot_number(range.high)};
  for (const auto& bar : chart.bars)
    data["bars"].push_back({{"label", bar.label},
                            {"colour", palette(bar.colour)},
                            {"value", plot_number(bar.value)},
                            {"error", plot_number(bar.error)}});
  return with_plot_data(to_svg(chart), data);
}

}  // namespace annulus::app
