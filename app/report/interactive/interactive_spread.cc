#include "app/report/interactive/plot_data.h"
#include "app/report/interactive_plot.h"

namespace annulus::app {

std::string plot_html(const SpreadPlot& plot) {
  nlohmann::json data = {{"kind", "curves"},
                         {"title", plot.title},
                         {"x_label", ""},
                         {"y_label", plot.y_label},
                         {"x_log", false},
                         {"y_log", false},
                         {"x_range", {0, plot.columns.size()}},
                         {"series", nlohmann::json::array()},
                         {"levels", nlohmann::json::array()},
                         {"names", nlohmann::json::array()}};
  for (std::size_t i = 0; i < plot.columns.size(); ++i) {
    const auto& c = plot.columns[i];
    const auto places = places_in_column(i, c.values.size());
    data["names"].push_back(c.label);
    const auto add = [&](const char* what, const char* style, const std::vector<double>& x,
                         const std::vector<double>& y) -> nlohmann::json& {
      data["series"].push_back({{"label", c.label + what},
                                {"colour", palette(c.colour)},
                                {"style", style},
                                {"dashed", false},
                                {"size", 4},
                                {"group", i},
                                {"x", plot_numbers(x)},
                                {"y", plot_numbers(y)}});
      return data["series"].back();
    };
    add("", "dots", places.samples, c.values)["fade"] = "80";
    add(": 5 to 95 %", "line", {places.box, places.box}, {c.q05, c.q95})["unnamed"] = true;
    auto& quartiles = add(": quartiles", "line", {places.box, places.box}, {c.q25, c.q75});
    quartiles["unnamed"] = true;
    quartiles["width"] = 16;
    quartiles["fade"] = "60";
    auto& median = add(": median", "dots", {places.box}, {c.median});
    median["unnamed"] = true;
    median["size"] = 9;
    auto& nominal = add(": as given", "dots", {places.nominal, places.nominal, places.nominal},
                        {c.nominal - c.nominal_error, c.nominal, c.nominal + c.nominal_error});
    nominal["unnamed"] = true;
    nominal["joined"] = true;
    nominal["colour"] = "#222222";
  }
  return with_plot_data(to_svg(plot), data);
}

}  // namespace annulus::app
