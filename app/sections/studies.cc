#include <fmt/format.h>

#include "app/sections/report_parts.h"

namespace annulus::app {

Legend legend_of(const std::vector<std::string>& names) {
  if (names.size() == 1 && names.front().empty()) return {};
  Legend legend;
  for (const auto& name : names) legend.emplace_back(name, legend.size());
  return legend;
}

void StudyOutcome::add(const StudyPoint& point, const std::string& place) {
  ++points;
  if (point.failure.empty()) {
    not_steady += point.value("steady") == 0 ? 1 : 0;
  } else if (failed++ == 0 && !place.empty()) {
    first = ", the first: " + place + ": " + point.failure;
  }
}

std::string StudyOutcome::text() const {
  std::string text;
  if (failed) text += fmt::format(" {} of {} responses failed and are left out{}.", failed, points, first);
  if (not_steady)
    text += fmt::format(" {} of {} responses are not periodic; their results hold for the evaluated window only.",
                        not_steady, points);
  return text;
}

std::vector<Section> study_sections(const Scene& scene, const StudyResults& studies) {
  return {sweeps_section(scene, studies), grids_section(scene, studies), load_spectrum_section(studies),
          transients_section(studies),    sensitivity_section(studies),  optimise_section(studies)};
}

}  // namespace annulus::app
