#include <fmt/format.h>

#include "app/model/run_options.h"
#include "app/results/content_id.h"
#include "app/study/studies.h"
#include "app/study/study_points.h"

namespace annulus::app {

namespace {

using Header = std::vector<std::pair<std::string, std::string>>;

std::vector<double> inputs_of(const StudyCase& study_case) {
  std::vector<double> values;
  for (const auto& change : study_case.overrides) values.push_back(change.value);
  return values;
}

/// The points of every variant as a table of its own.
void write_points(const StudySubject& subject, const std::string& file, const Header& header,
                  const std::vector<StudyCase>& cases, const CasePoints& points) {
  PointColumns columns{.header = header, .results = figure_keys(subject.figures())};
  for (const auto& change : cases.front().overrides) columns.inputs.push_back(file_name(change.input));
  for (std::size_t variant = 0; variant < points.variants.size(); ++variant) {
    auto csv = columns.empty_table();
    for (std::size_t i = 0; i < cases.size(); ++i)
      columns.add(csv, i + 1, inputs_of(cases[i]), points.variants[variant][i]);
    csv.write(subject.folder(variant) / file);
  }
}

void write_poincare(const StudySubject& subject, const std::string& file, const Header& header,
                    const std::vector<StudyCase>& cases, const CasePoints& points) {
  for (std::size_t variant = 0; variant < points.variants.size(); ++variant) {
    Csv csv{.header = {{"annulus_version", version()}},
            .columns = {file_name(cases.front().overrides.front().input), "mesh_cycle", "force_N", "deflection_m"},
            .rows = {}};
    csv.header.insert(csv.header.end(), header.begin(), header.end());
    for (std::size_t i = 0; i < cases.size(); ++i) {
      double cycle = 0;
      for (const auto& p : points.variants[variant][i].poincare)
        csv.rows.push_back({cases[i].overrides.front().value, cycle++, p.force, p.deflection});
    }
    if (!csv.rows.empty()) csv.write(subject.folder(variant) / file);
  }
}

}  // namespace

SweepResult run_sweep(const StudySubject& subject, std::size_t sweep) {
  const auto& input = subject.scene().sweeps.at(sweep);
  const auto cases = sweep_cases(subject.scene(), sweep);
  auto points = run_cases(subject, cases, "sweep over " + input.input);
  const auto unit = unit_of_input(subject.scene(), input.input);
  const Header header = {{"input", input.input}, {"unit", unit}};
  write_points(subject, fmt::format("sweep_{}.csv", sweep + 1), header, cases, points);
  write_poincare(subject, fmt::format("sweep_{}_poincare.csv", sweep + 1), header, cases, points);
  return {.sweep = input,
          .unit = unit,
          .values = input.points(),
          .tables = points.tables,
          .variants = std::move(points.variants)};
}

GridResult run_grid(const StudySubject& subject, std::size_t grid) {
  const auto& input = subject.scene().grids.at(grid);
  const auto cases = grid_cases(subject.scene(), grid);
  auto points = run_cases(subject, cases, fmt::format("grid over {} and {}", input.x.input, input.y.input));
  GridResult result{.grid = input,
                    .x_unit = unit_of_input(subject.scene(), input.x.input),
                    .y_unit = unit_of_input(subject.scene(), input.y.input),
                    .x = input.x.points(),
                    .y = input.y.points(),
                    .tables = points.tables,
                    .variants = {}};
  write_points(
      subject, fmt::format("grid_{}.csv", grid + 1),
      {{"x_input", input.x.input}, {"x_unit", result.x_unit}, {"y_input", input.y.input}, {"y_unit", result.y_unit}},
      cases, points);
  result.variants = std::move(points.variants);
  return result;
}

}  // namespace annulus::app
