#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/model/run_options.h"
#include "app/results/content_id.h"
#include "app/study/directed_sweeps.h"
#include "app/study/studies.h"
#include "app/study/study_points.h"
#include "app/study/summary_studies.h"
#include "core/csv.h"
#include "core/files.h"

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

/// Branches point by point; where stability changes stands in a file of its own, whose first column is a word.
void write_branches(const StudySubject& subject, std::size_t sweep, const Header& header,
                    const std::vector<SweepBranches>& branches) {
  const auto input = file_name(subject.scene().sweeps.at(sweep).input);
  for (std::size_t variant = 0; variant < branches.size(); ++variant) {
    Csv csv{.header = {{"annulus_version", version()}},
            .columns = {"branch", input, "mesh_force_max_N", "contact_loss", "largest_multiplier", "stable"},
            .rows = {}};
    csv.header.insert(csv.header.end(), header.begin(), header.end());
    std::string events = fmt::format("# annulus_version: {}\nkind,branch,{},error\n", version(), input);
    double number = 1;
    for (const auto& branch : branches[variant].branches) {
      for (const auto& p : branch.points)
        csv.rows.push_back({number, p.input, p.largest_force, p.contact_loss, p.multiplier, p.stable ? 1.0 : 0.0});
      for (const auto& e : branch.events)
        events += fmt::format("{},{},{:.17g},{:.3g}\n", to_string(e.kind), number, e.input, e.error);
      ++number;
    }
    csv.write(subject.folder(variant) / fmt::format("sweep_{}_branches.csv", sweep + 1));
    write_file(subject.folder(variant) / fmt::format("sweep_{}_branch_events.csv", sweep + 1), events);
  }
}

/// Variants by falling value of the ordering figure; empty when one failed.
std::vector<std::size_t> order_of(const std::vector<StudyPoint>& variants, const std::string& figure) {
  std::vector<std::size_t> order(variants.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (std::any_of(variants.begin(), variants.end(), [](const auto& point) { return !point.failure.empty(); }))
    return {};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return variants[a].value(figure) > variants[b].value(figure); });
  return order;
}

/// Input and variant are words, so the file is no table of numbers alone.
std::string sensitivity_csv(const StudySubject& subject, const SensitivityResult& result) {
  const auto word = variant_word(subject.scene().stage.kind);
  std::string text =
      fmt::format("# annulus_version: {}\n# factor: {:.17g}\ninput,{},value", version(), result.factor, word);
  const auto& figures = subject.figures();
  const auto& names = subject.variants();
  for (const auto* which : {"divided_", "nominal_", "multiplied_"}) {
    for (const auto& figure : figures) text += std::string(",") + which + figure.key;
  }
  text += "," + order_column(word) + "\n";
  for (const auto& row : result.rows) {
    for (std::size_t variant = 0; variant < names.size(); ++variant) {
      text += fmt::format("{},{},{:.17g}", row.input, csv_cell(names[variant]), row.values[variant]);
      for (const auto* point : {&row.divided[variant], &result.nominal[variant], &row.multiplied[variant]}) {
        for (const auto& figure : figures) text += fmt::format(",{:.17g}", point->value(figure.key));
      }
      text += row.order_stays ? ",1\n" : ",0\n";
    }
  }
  return text;
}

}  // namespace

SweepResult run_sweep(const StudySubject& subject, std::size_t sweep) {
  const auto& input = subject.scene().sweeps.at(sweep);
  const auto cases = sweep_cases(subject.scene(), sweep);
  const auto label = "sweep over " + input.input;
  const auto unit = unit_of_input(subject.scene(), input.input);
  const Header header = {{"input", input.input}, {"unit", unit}};
  SweepResult result{.sweep = input, .unit = unit, .values = input.points(), .variants = {}};
  const auto take = [&](CasePoints points, const std::string& suffix) {
    result.tables = std::max(result.tables, points.tables);
    write_points(subject, fmt::format("sweep_{}{}.csv", sweep + 1, suffix), header, cases, points);
    write_poincare(subject, fmt::format("sweep_{}_poincare{}.csv", sweep + 1, suffix), header, cases, points);
    return std::move(points.variants);
  };
  if (input.direction == SweepDirection::each) {
    result.variants = take(run_cases(subject, cases, label), "");
    return result;
  }
  if (input.goes_up()) result.variants = take(run_in_order(subject, cases, SweepOrder::rising, label + ", up"), "");
  if (input.goes_down()) {
    auto down =
        take(run_in_order(subject, cases, SweepOrder::falling, label + ", down"), input.goes_up() ? "_down" : "");
    (input.goes_up() ? result.downwards : result.variants) = std::move(down);
  }
  if (input.direction == SweepDirection::branches) {
    result.branches = find_branches(subject, sweep);
    write_branches(subject, sweep, header, result.branches);
  }
  return result;
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

SensitivityResult run_sensitivity(const StudySubject& subject) {
  const auto& scene = subject.scene();
  const auto inputs = sensitivity_inputs(scene);
  auto cases = sensitivity_cases(scene);
  cases.push_back(nominal_case_of_sensitivity());
  const auto points = run_cases(subject, cases, "sensitivity");
  const auto column = [&](std::size_t i) {
    std::vector<StudyPoint> list;
    for (const auto& variant : points.variants) list.push_back(variant[i]);
    return list;
  };
  const auto* ordering = ordering_figure(subject.figures());
  const std::string figure = ordering ? ordering->key : "";
  SensitivityResult result{scene.sensitivity->factor, column(cases.size() - 1), {}};
  const auto order = order_of(result.nominal, figure);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto target = find_input(scene, inputs[i]);
    SensitivityRow row{inputs[i], target.parameter->unit, {}, column(2 * i), column(2 * i + 1), false};
    for (std::size_t variant = 0; variant < points.variants.size(); ++variant) {
      const bool has =
          !target.by_variant || std::find(target.tables.begin(), target.tables.end(), variant) != target.tables.end();
      row.values.push_back(has ? value_in_variant(scene, target, variant).value_or(0) : not_known);
    }
    row.order_stays =
        !order.empty() && order_of(row.divided, figure) == order && order_of(row.multiplied, figure) == order;
    result.rows.push_back(std::move(row));
  }
  const auto& out = subject.options().out;
  std::filesystem::create_directories(out);
  write_file(out / "sensitivity.csv", sensitivity_csv(subject, result));
  return result;
}

}  // namespace annulus::app
