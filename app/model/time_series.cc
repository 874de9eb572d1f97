#include "app/model/time_series.h"

namespace annulus::app {

Csv time_series_table(const dynamics::TimeSeries& series, int stride) {
  Csv csv;
  csv.columns.emplace_back("time_s");
  for (const auto& name : series.dofs) csv.columns.push_back(name + "_m");
  for (const auto& name : series.meshes) csv.columns.push_back(name + "_force_N");
  csv.rows.reserve(static_cast<std::size_t>(series.time.size() / stride + 1));
  for (Eigen::Index i = 0; i < series.time.size(); i += stride) {
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
