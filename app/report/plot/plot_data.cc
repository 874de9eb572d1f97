#include "app/report/plot/plot_data.h"

#include <cmath>

namespace annulus::app {

nlohmann::json plot_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == 0) return 0;
  const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(scale) && scale > 0 ? std::round(value * scale) / scale : value;
}

nlohmann::json plot_numbers(const std::vector<double>& values) {
  auto list = nlohmann::json::array();
  for (const double v : values) list.push_back(plot_number(v));
  return list;
}

std::string script_text(const nlohmann::json& data) {
  // "</script>" and "<!--" within a text would end the element.
  const std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

}  // namespace annulus::app
