#include "app/study_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace annulus::app {

namespace {
constexpr std::size_t listed_frequencies = 6;
constexpr double no_figure = std::numeric_limits<double>::quiet_NaN();
}  // namespace

std::vector<std::string> figure_columns(bool motion) {
  std::vector<std::string> names;
  for (const std::string mesh : {"sun_planet", "ring_planet"}) {
    for (const auto* figure : {"_load_sharing_averaged", "_load_sharing_instantaneous", "_load_sharing_quasi_static",
                               "_dynamic_factor", "_contact_loss"})
      names.push_back(mesh + figure);
  }
  names.emplace_back("steady");
  if (!motion) return names;
  for (const std::string motion_of : {"sun", "sun_planet_deflection", "ring_planet_deflection"}) {
    names.push_back(motion_of + "_rms_m");
    names.push_back(motion_of + "_peak_to_peak_m");
  }
  for (std::size_t i = 1; i <= listed_frequencies; ++i) names.push_back(fmt::format("frequency_{}_Hz", i));
  return names;
}

std::vector<double> figure_row(const StudyPoint& point, bool motion) {
  if (!point.failure.empty()) return std::vector<double>(figure_columns(motion).size(), no_figure);
  const auto& f = point.figures;
  std::vector<double> row;
  for (const auto* kind : {&f.sun_planet, &f.ring_planet})
    row.insert(row.end(),
               {kind->averaged, kind->instantaneous, kind->quasi_static, kind->dynamic_factor, kind->contact_loss});
  row.push_back(f.steady ? 1 : 0);
  if (!motion) return row;
  for (const auto* m : {&f.sun, &f.sun_mesh, &f.ring_mesh}) row.insert(row.end(), {m->rms, m->peak_to_peak});
  for (std::size_t i = 0; i < listed_frequencies; ++i)
    row.push_back(i < f.frequencies.size() ? f.frequencies[i] : no_figure);
  return row;
}

const FigureStatistics* MonteCarloRing::find(const std::string& figure) const {
  const auto found =
      std::find_if(statistics.begin(), statistics.end(), [&](const auto& s) { return s.figure == figure; });
  return found == statistics.end() ? nullptr : &*found;
}

}  // namespace annulus::app
