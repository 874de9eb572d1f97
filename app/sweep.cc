#include <fmt/format.h>

#include "app/content_id.h"
#include "app/studies.h"
#include "app/study_runner.h"

namespace annulus::app {

namespace {

void write_sweep(const RunResult& nominal, const std::filesystem::path& out, std::size_t number,
                 const SweepResult& result) {
  const std::vector<std::pair<std::string, std::string>> header = {
      {"annulus_version", version()}, {"input", result.sweep.input}, {"unit", result.unit}};
  for (std::size_t ring = 0; ring < nominal.rings.size(); ++ring) {
    Csv figures, poincare;
    figures.header = poincare.header = header;
    figures.columns = {file_name(result.sweep.input), "failed"};
    for (const auto& name : figure_columns(true)) figures.columns.push_back(name);
    poincare.columns = {file_name(result.sweep.input), "mesh_cycle", "sun_planet1_force_N", "sun_planet1_deflection_m"};
    for (std::size_t i = 0; i < result.values.size(); ++i) {
      const auto& point = result.rings[ring][i];
      std::vector<double> row = {result.values[i], point.failure.empty() ? 0.0 : 1.0};
      const auto values = figure_row(point, true);
      row.insert(row.end(), values.begin(), values.end());
      figures.rows.push_back(std::move(row));
      if (!point.failure.empty()) figures.header.emplace_back(fmt::format("failure_{}", i + 1), point.failure);
      double cycle = 0;
      for (const auto& p : point.figures.poincare)
        poincare.rows.push_back({result.values[i], cycle++, p.force, p.deflection});
    }
    const auto folder = out / nominal.rings[ring].name / "dynamics";
    std::filesystem::create_directories(folder);
    figures.write(folder / fmt::format("sweep_{}.csv", number));
    poincare.write(folder / fmt::format("sweep_{}_poincare.csv", number));
  }
}

}  // namespace

SweepResult run_sweep(const RunResult& nominal, const RunOptions& options, std::size_t sweep) {
  const auto& input = nominal.scene.sweeps.at(sweep);
  const ChangedStages stages(nominal, options);
  auto points = run_cases(stages, sweep_cases(nominal.scene, sweep), "sweep over " + input.input);
  SweepResult result{.sweep = input,
                     .unit = find_input(nominal.scene, input.input).parameter->unit,
                     .values = input.points(),
                     .tables = points.tables,
                     .rings = std::move(points.rings)};
  write_sweep(nominal, options.out, sweep + 1, result);
  return result;
}

}  // namespace annulus::app
