#include <fmt/format.h>

#include "app/model/run_options.h"
#include "app/results/content_id.h"
#include "app/study/studies.h"
#include "app/study/study_runner.h"

namespace annulus::app {

namespace {

void add_point(Csv& csv, std::vector<double> row, const StudyPoint& point, const std::vector<FigureSpec>& figures,
               std::size_t number) {
  row.push_back(point.failure.empty() ? 0.0 : 1.0);
  for (const auto& figure : figures) row.push_back(point.value(figure.key));
  csv.rows.push_back(std::move(row));
  if (!point.failure.empty()) csv.header.emplace_back(fmt::format("failure_{}", number), point.failure);
}

void write_sweep(const StudySubject& subject, std::size_t number, const SweepResult& result) {
  const std::vector<std::pair<std::string, std::string>> header = {
      {"annulus_version", version()}, {"input", result.sweep.input}, {"unit", result.unit}};
  const auto& specs = subject.figures();
  for (std::size_t variant = 0; variant < result.variants.size(); ++variant) {
    Csv figures, poincare;
    figures.header = poincare.header = header;
    figures.columns = {file_name(result.sweep.input), "failed"};
    for (const auto& f : specs) figures.columns.push_back(f.key);
    poincare.columns = {file_name(result.sweep.input), "mesh_cycle", "force_N", "deflection_m"};
    for (std::size_t i = 0; i < result.values.size(); ++i) {
      const auto& point = result.variants[variant][i];
      add_point(figures, {result.values[i]}, point, specs, i + 1);
      double cycle = 0;
      for (const auto& p : point.poincare) poincare.rows.push_back({result.values[i], cycle++, p.force, p.deflection});
    }
    const auto folder = subject.folder(variant);
    std::filesystem::create_directories(folder);
    figures.write(folder / fmt::format("sweep_{}.csv", number));
    if (!poincare.rows.empty()) poincare.write(folder / fmt::format("sweep_{}_poincare.csv", number));
  }
}

void write_grid(const StudySubject& subject, std::size_t number, const GridResult& result) {
  const auto& specs = subject.figures();
  for (std::size_t variant = 0; variant < result.variants.size(); ++variant) {
    Csv csv;
    csv.header = {{"annulus_version", version()},
                  {"x_input", result.grid.x.input},
                  {"x_unit", result.x_unit},
                  {"y_input", result.grid.y.input},
                  {"y_unit", result.y_unit}};
    csv.columns = {file_name(result.grid.x.input), file_name(result.grid.y.input), "failed"};
    for (const auto& f : specs) csv.columns.push_back(f.key);
    for (std::size_t i = 0; i < result.variants[variant].size(); ++i)
      add_point(csv, {result.x[i % result.x.size()], result.y[i / result.x.size()]}, result.variants[variant][i], specs,
                i + 1);
    const auto folder = subject.folder(variant);
    std::filesystem::create_directories(folder);
    csv.write(folder / fmt::format("grid_{}.csv", number));
  }
}

}  // namespace

SweepResult run_sweep(const StudySubject& subject, std::size_t sweep) {
  const auto& input = subject.scene().sweeps.at(sweep);
  auto points = run_cases(subject, sweep_cases(subject.scene(), sweep), "sweep over " + input.input);
  SweepResult result{.sweep = input,
                     .unit = find_input(subject.scene(), input.input).parameter->unit,
                     .values = input.points(),
                     .tables = points.tables,
                     .variants = std::move(points.variants)};
  write_sweep(subject, sweep + 1, result);
  return result;
}

GridResult run_grid(const StudySubject& subject, std::size_t grid) {
  const auto& input = subject.scene().grids.at(grid);
  auto points = run_cases(subject, grid_cases(subject.scene(), grid),
                          fmt::format("grid over {} and {}", input.x.input, input.y.input));
  GridResult result{.grid = input,
                    .x_unit = find_input(subject.scene(), input.x.input).parameter->unit,
                    .y_unit = find_input(subject.scene(), input.y.input).parameter->unit,
                    .x = input.x.points(),
                    .y = input.y.points(),
                    .tables = points.tables,
                    .variants = std::move(points.variants)};
  write_grid(subject, grid + 1, result);
  return result;
}

}  // namespace annulus::app
