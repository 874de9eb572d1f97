#include "app/sections/report_parts.h"

namespace annulus::app {

std::vector<Picture> on_one_scale(std::vector<Plot> plots, const RangeFinder& range) {
  std::vector<Picture> pictures;
  for (auto& plot : plots) {
    plot.y_range = range.range();
    pictures.emplace_back(std::move(plot));
  }
  return pictures;
}

CycleCurve cycle_curve(const MeshResult& mesh, const std::function<double(const StiffnessEntry&)>& pick, int pieces) {
  CycleCurve curve;
  const auto& table = mesh.table;
  const int phases = table.phases(), total = phases * table.positions();
  std::vector<double> error;
  for (int i = 0; i < total; ++i) {
    const auto& e = table.at(i / phases, i % phases, static_cast<int>(mesh.nominal));
    curve.solved_cycles.push_back(static_cast<double>(i) / phases);
    curve.solved.push_back(pick(e));
    error.push_back(e.error_relative);
  }
  const PeriodicCurve through(curve.solved, phases);
  curve.mean = through.mean();
  for (int i = 0; i <= total * pieces; ++i) {
    const double cycle = static_cast<double>(i) / (phases * pieces);
    const double value = pieces == 1 ? curve.solved[static_cast<std::size_t>(i % total)] : through(cycle);
    const double e = error[static_cast<std::size_t>(((i + pieces / 2) / pieces) % total)];
    curve.cycles.push_back(cycle);
    curve.value.push_back(value);
    curve.low.push_back(value * (1 - e));
    curve.high.push_back(value * (1 + e));
  }
  return curve;
}

double secant_N_per_um(const StiffnessEntry& entry) { return entry.stiffness_secant / 1e6; }

double mean_at_load(const StiffnessTable& table, std::size_t load,
                    const std::function<double(const StiffnessEntry&)>& pick) {
  double sum = 0;
  for (int p = 0; p < table.positions(); ++p)
    for (int k = 0; k < table.phases(); ++k) sum += pick(table.at(p, k, static_cast<int>(load)));
  return sum / (table.positions() * table.phases());
}

std::vector<double> column_values(const Csv& csv, const std::string& name, double rows_to, double scale) {
  const auto column = csv.column(name);
  std::vector<double> list;
  for (const auto& row : csv.rows)
    if (row[0] < rows_to) list.push_back(scale == 1 ? row[column] : scale * row[column]);
  return list;
}

}  // namespace annulus::app
