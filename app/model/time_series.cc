#include "app/model/time_series.h"

#include <fmt/format.h>

namespace annulus::app {

Eigen::Index written_samples(const dynamics::TimeSeries& series, int window_cycles, Csv& csv) {
  constexpr int most = dynamics::long_window;
  if (window_cycles <= most) return series.time.size();
  csv.header.emplace_back("mesh_cycles", fmt::format("{} of {}", most, window_cycles));
  return series.time.size() / window_cycles * most;
}

Csv time_series_table(const dynamics::TimeSeries& series, int window_cycles) {
  Csv csv;
  const auto samples = written_samples(series, window_cycles, csv);
  csv.columns.emplace_back("time_s");
  for (const auto& name : series.dofs) csv.columns.push_back(name + "_m");
  for (const auto& name : series.meshes) csv.columns.push_back(name + "_force_N");
  csv.rows.reserve(static_cast<std::size_t>(samples));
  for (Eigen::Index i = 0; i < samples; ++i) {
    auto& row = csv.rows.emplace_back();
    row.reserve(csv.columns.size());
    row.push_back(series.time[i]);
    row.insert(row.end(), series.displacement.col(i).begin(), series.displacement.col(i).end());
    row.insert(row.end(), series.force.col(i).begin(), series.force.col(i).end());
  }
  csv.round();
  return csv;
}

}  // namespace annulus::app
