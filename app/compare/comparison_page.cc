#include "app/compare/comparison_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/compare/compared_quantities.h"
#include "app/results/content_id.h"
#include "app/sections/report_parts.h"
#include "core/csv.h"
#include "core/files.h"
#include "core/text_columns.h"

namespace annulus::app {

namespace {

constexpr const char* csv_columns =
    "result,unit,variant,value,error,difference_to_first,errors_together,against_first\n";

/// A table with one column per variant.
PageTable variant_table(const Comparison& comparison) {
  PageTable table{.head = {""}, .style = PageTable::Style::numbers};
  table.head.insert(table.head.end(), comparison.variants.begin(), comparison.variants.end());
  return table;
}

void add_row(PageTable& table, const Text& name, const std::vector<std::string>& cells) {
  auto& row = table.rows.emplace_back(1, name);
  row.insert(row.end(), cells.begin(), cells.end());
}

Section figures_part(const Comparison& comparison) {
  auto table = variant_table(comparison);
  for (const auto& quantity : comparison.quantities) {
    if (quantity.has_spread) add_row(table, quantity.shown.name + spread_words, quantity.spreads);
    add_row(table, quantity.shown.name + (quantity.has_spread ? nominal_words : ""), quantity.cells);
  }
  return {
      "figures", "Results",
      paragraph(
          "± is the estimated numerical error; it does not contain the uncertainty of the inputs. A value without ± is "
          "exact or prescribed, or its error is not known; the differences state which. If phases of errors or other "
          "inputs are not known, the result is the spread over samples. The nominal value is one of them.") +
          table};
}

Section differences_part(const Comparison& comparison) {
  Section section{"differences", "Differences"};
  PageTable table{.head = {"result", "difference"}};
  for (const auto& quantity : comparison.quantities)
    if (const auto& texts = quantity.differences; !texts.empty())
      table.rows.push_back({quantity.shown.name, joined({texts.begin(), texts.end()}, line_break())});
  if (!table.rows.empty())
    section.blocks =
        paragraph(phrase(
            "Compared with {}. A difference is not significant if it is not larger than both error bars together.",
            bold(comparison.variants.front()))) +
        table;
  return section;
}

Section inputs_part(const Comparison& comparison) {
  Section section{"inputs", "Inputs that differ"};
  if (comparison.inputs.empty()) {
    section.blocks += paragraph("No input differs.");
    return section;
  }
  auto table = variant_table(comparison);
  for (const auto& input : comparison.inputs) add_row(table, code(input.key), input.values);
  section.blocks += table;
  return section;
}

Section cost_part(const std::vector<ComparedRun>& runs) {
  PageTable table{.head = {"scene"}, .style = PageTable::Style::numbers};
  std::vector<std::string> stages;
  for (const auto& run : runs)
    for (const auto& [stage, seconds] : run.timings)
      if (std::find(stages.begin(), stages.end(), stage) == stages.end()) stages.push_back(stage);
  for (const auto& stage : stages) table.head.emplace_back(stage + ", s");
  for (const char* head : {"peak memory, MB", "results read back", "accuracy wanted", "annulus"})
    table.head.emplace_back(head);
  for (const auto& run : runs) {
    std::vector<Text> row = {run.name};
    for (const auto& stage : stages) {
      const auto found =
          std::find_if(run.timings.begin(), run.timings.end(), [&](const auto& t) { return t.first == stage; });
      row.emplace_back(found == run.timings.end() ? "–" : fmt::format("{:.2f}", found->second));
    }
    row.emplace_back(fmt::format("{:.0f}", run.peak_memory_MB));
    row.emplace_back(fmt::format("{}", run.read_back));
    row.emplace_back(to_text(run.accuracy));
    row.emplace_back(run.version);
    table.rows.push_back(std::move(row));
  }
  return {
      "cost", "Time and memory",
      paragraph(
          "Wall time of the last run of each scene; results that were read back from an earlier run cost no time.") +
          table};
}

}  // namespace

std::string comparison_text(const std::vector<ComparedRun>& runs) {
  const Comparison comparison(runs);
  const auto& variants = comparison.variants;
  constexpr std::size_t name_width = 64, least_width = 22;
  std::string text;
  const auto add_line = [&](const std::string& name, const std::vector<std::string>& cells) {
    text += left_aligned(name, name_width);
    for (std::size_t i = 0; i < cells.size(); ++i)
      text += left_aligned(cells[i], std::max(least_width, variants[i].size() + 2));
    text += "\n";
  };
  add_line("", variants);
  for (const auto& quantity : comparison.quantities) {
    if (quantity.has_spread) add_line(quantity.shown.name + spread_words, quantity.spreads);
    add_line(quantity.has_spread ? std::string("   ") + nominal_words : quantity.shown.name, quantity.cells);
  }
  text += "\nAgainst " + variants.front() + "\n";
  for (const auto& quantity : comparison.quantities)
    for (const auto& difference : quantity.differences) text += "  " + quantity.shown.name + ": " + difference + "\n";
  text += comparison.inputs.empty() ? "\nNo input differs.\n" : "\nInputs that differ\n";
  for (const auto& input : comparison.inputs)
    text += fmt::format("  {} {}\n", left_aligned(input.key, 40), fmt::join(input.values, " | "));
  text += "\n";
  for (const auto& run : runs) {
    double total = 0;
    for (const auto& [stage, seconds] : run.timings)
      if (stage == "total") total = seconds;
    text += left_aligned("cost    " + run.name, 40) +
            fmt::format("{:.2f} s, {:.0f} MB{}\n", total, run.peak_memory_MB,
                        run.read_back > 0 ? fmt::format(", {} results read back", run.read_back) : "");
  }
  return text;
}

Json comparison_json(const std::vector<ComparedRun>& runs) {
  Json json = {{"kind", runs.front().kind}, {"results", Json::array()}, {"inputs_that_differ", Json::array()}};
  const Comparison comparison(runs);
  for (const auto& quantity : comparison.quantities) {
    Json item = {{"key", quantity.spec.key}};  // which states the unit, as everywhere in files
    for (const auto& m : quantity.si.variants) {
      Json value = {{"variant", m.variant}, {"value", json_number(m.value)}, {"error", json_number(m.error)}};
      if (m.spread) value["spread"] = to_json(*m.spread);
      item["values"].push_back(std::move(value));
    }
    json["results"].push_back(std::move(item));
  }
  for (const auto& input : comparison.inputs)
    json["inputs_that_differ"].push_back({{"key", input.key}, {"values", input.values}});
  return json;
}

bool is_comparison_table(const std::filesystem::path& file) {
  const auto text = read_file(file);
  return text.starts_with("# annulus_version: ") && text.find(csv_columns) != std::string::npos;
}

std::string comparison_csv(const std::vector<ComparedRun>& runs) {
  std::string text = fmt::format("# annulus_version: {}\n# kind: {}\n", version(), runs.front().kind);
  for (const auto& run : runs) text += "# run: " + csv_remark(run.name + " = " + run.folder.string()) + "\n";
  text += csv_columns;
  for (const auto& quantity : Comparison(runs).quantities) {
    const auto& spec = quantity.spec;
    const auto& shown = quantity.shown;
    const auto& first = shown.variants.front();
    for (const auto& m : shown.variants) {
      text += fmt::format("{},{},{},{},{},", csv_cell(spec.title), spec.unit, csv_cell(m.variant), csv_cell(m.value),
                          csv_cell(m.error));
      text += &m == &first ? ",,\n"
                           : fmt::format("{},{},{}\n", csv_cell(m.value - first.value), csv_cell(m.error + first.error),
                                         csv_cell(difference_text(first, m, shown.digits)));
    }
  }
  return text;
}

Page comparison_page(const std::vector<ComparedRun>& runs) {
  const Comparison comparison(runs);
  std::vector<VariantQuantity> plain;
  for (const auto& quantity : comparison.quantities) plain.push_back(quantity.si);
  std::vector<Text> names;
  List scenes;
  for (const auto& run : runs) {
    names.emplace_back(run.name);
    scenes.items.push_back(bold(run.name) + ": " + run.title);
  }
  Blocks answer = answer_sentences(plain);
  if (answer.empty()) answer = paragraph("These runs have no common stiffness and no common load sharing.");
  return {
      .title = "Comparison of " + enumerated(names).plain(),
      .sub = fmt::format("annulus {} · {} finished runs", version(), runs.size()),
      .summary = verdict_box(answer) + answer_picture(plain, comparison.variants) + scenes,
      .sections = {figures_part(comparison), differences_part(comparison), inputs_part(comparison), cost_part(runs)}};
}

std::string comparison_html(const std::vector<ComparedRun>& runs) { return page_html(comparison_page(runs)); }

}  // namespace annulus::app
