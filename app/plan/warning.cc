#include "app/plan/warning.h"

#include <algorithm>

namespace annulus::app {

const char* to_text(Severity severity) {
  return severity == Severity::severe ? "severe" : severity == Severity::warning ? "warning" : "note";
}

std::string to_text(const Warning& warning) {
  return std::string(to_text(warning.severity)) + ": " + (warning.where.empty() ? "" : warning.where + ": ") +
         warning.text;
}

Json to_json(const std::vector<Warning>& warnings) {
  Json list = Json::array();
  for (const auto& w : warnings) {
    Json item = {{"key", w.key}, {"severity", to_text(w.severity)}, {"text", w.text}};
    if (!w.where.empty()) item["where"] = w.where;
    list.push_back(std::move(item));
  }
  return list;
}

std::vector<Warning> by_severity(std::vector<Warning> warnings) {
  std::stable_sort(warnings.begin(), warnings.end(),
                   [](const Warning& a, const Warning& b) { return a.severity > b.severity; });
  return warnings;
}

bool any_warning(const std::vector<Warning>& warnings) {
  return std::any_of(warnings.begin(), warnings.end(), [](const Warning& w) { return w.severity > Severity::note; });
}

}  // namespace annulus::app
