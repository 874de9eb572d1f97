#include "app/compare/comparison_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/compare/compared_quantities.h"
#include "app/results/content_id.h"
#include "app/sections/report_parts.h"

namespace annulus::app {

namespace {

std::vector<std::string> variant_names(const std::vector<ComparedRun>& runs) {
  std::vector<std::string> names;
  for (const auto* variant : all_variants(runs)) names.push_back(variant->name);
  return names;
}

/// A table with one column per variant.
PageTable variant_table(const std::vector<ComparedRun>& runs) {
  PageTable table{.head = {""}, .style = PageTable::Style::numbers};
  for (const auto& name : variant_names(runs)) table.head.emplace_back(name);
  return table;
}

Section figures_part(const std::vector<ComparedRun>& runs, const std::vector<ComparedQuantity>& quantities) {
  auto table = variant_table(runs);
  for (const auto& compared : quantities) {
    const auto quantity = in_unit(compared);
    std::vector<Text> row = {quantity.name};
    for (const auto& name : variant_names(runs)) {
      const auto found =
          std::find_if(quantity.rings.begin(), quantity.rings.end(), [&](const Measured& m) { return m.ring == name; });
      row.emplace_back(found == quantity.rings.end() ? "–" : measured(found->value, found->error));
    }
    table.rows.push_back(std::move(row));
  }
  return {"figures", "Figures",
          paragraph(
              "± is the estimated numerical error; it does not contain the uncertainty of the inputs. A value without "
              "one is exact, as given, or its error is not known; the differences tell which.") +
              table};
}

Section differences_part(const std::vector<ComparedRun>& runs, const std::vector<ComparedQuantity>& quantities) {
  Section section{"differences", "Differences"};
  PageTable table{.head = {"figure", "difference"}};
  for (const auto& compared : quantities) {
    const auto texts = difference_texts(compared);
    const Text cell = joined({texts.begin(), texts.end()}, line_break());
    if (!cell.empty()) table.rows.push_back({in_unit(compared).name, cell});
  }
  if (!table.rows.empty())
    section.blocks =
        paragraph(phrase("Against {}. A difference that is not larger than both error bars together says nothing.",
                         bold(variant_names(runs).front()))) +
        table;
  return section;
}

Section inputs_part(const std::vector<ComparedRun>& runs) {
  Section section{"inputs", "Inputs that differ"};
  const auto inputs = differing_inputs(runs);
  const auto unknown = unknown_inputs_text(runs);
  if (!unknown.empty()) section.blocks += paragraph(unknown);
  if (inputs.empty()) {
    if (unknown.empty()) section.blocks += paragraph("No input differs.");
    return section;
  }
  auto table = variant_table(runs);
  for (const auto& input : inputs) {
    std::vector<Text> row = {code(input.key)};
    for (const auto& value : input.values) row.emplace_back(value);
    table.rows.push_back(std::move(row));
  }
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
      paragraph("Wall time of the last run of each scene; results that were read back from an earlier run cost none.") +
          table};
}

}  // namespace

Page comparison_page(const std::vector<ComparedRun>& runs) {
  const auto quantities = compared_quantities(runs);
  std::vector<RingQuantity> plain;
  plain.reserve(quantities.size());
  for (const auto& compared : quantities) plain.push_back(compared.quantity);
  std::vector<Text> names;
  List scenes;
  for (const auto& run : runs) {
    names.emplace_back(run.name);
    scenes.items.push_back(bold(run.name) + ": " + run.title);
  }
  Blocks answer = answer_sentences(plain);
  if (answer.empty()) answer = paragraph("These runs hold neither stiffness nor load sharing in common.");
  return {.title = "Comparison of " + enumerated(names).plain(),
          .sub = fmt::format("annulus {} · {} finished runs", version(), runs.size()),
          .summary = verdict_box(answer) + answer_picture(plain, variant_names(runs)) + scenes,
          .sections = {figures_part(runs, quantities), differences_part(runs, quantities), inputs_part(runs),
                       cost_part(runs)}};
}

std::string comparison_html(const std::vector<ComparedRun>& runs) { return page_html(comparison_page(runs)); }

}  // namespace annulus::app
