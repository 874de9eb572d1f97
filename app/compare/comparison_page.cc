#include "app/compare/comparison_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/compare/compared_quantities.h"
#include "app/content_id.h"
#include "app/report/report_parts.h"

namespace annulus::app {

namespace {

std::vector<std::string> variant_names(const std::vector<ComparedRun>& runs) {
  std::vector<std::string> names;
  for (const auto* variant : all_variants(runs)) names.push_back(variant->name);
  return names;
}

/// A table with one column per variant.
HtmlTable variant_table(const std::vector<ComparedRun>& runs) {
  HtmlTable table{.head = {""}, .rows = {}, .css_class = "numbers"};
  for (const auto& name : variant_names(runs)) table.head.push_back(escape(name));
  return table;
}

std::string figures_part(const std::vector<ComparedRun>& runs, const std::vector<ComparedQuantity>& quantities) {
  auto table = variant_table(runs);
  for (const auto& compared : quantities) {
    const auto quantity = in_unit(compared);
    std::vector<std::string> row = {escape(quantity.name)};
    for (const auto& name : variant_names(runs)) {
      const auto found =
          std::find_if(quantity.rings.begin(), quantity.rings.end(), [&](const Measured& m) { return m.ring == name; });
      row.push_back(found == quantity.rings.end() ? "–" : measured(found->value, found->error));
    }
    table.rows.push_back(std::move(row));
  }
  return "<h2 id=\"figures\">Figures</h2>\n<p>± is the estimated numerical error; it does not contain the uncertainty "
         "of the inputs. A value without one is exact, as given, or its error is not known; the differences tell "
         "which.</p>\n" +
         html(table);
}

std::string differences_part(const std::vector<ComparedRun>& runs, const std::vector<ComparedQuantity>& quantities) {
  HtmlTable table{.head = {"figure", "difference"}, .rows = {}};
  for (const auto& compared : quantities) {
    std::string cell;
    for (const auto& text : difference_texts(compared)) cell += (cell.empty() ? "" : "<br>") + escape(text);
    if (!cell.empty()) table.rows.push_back({escape(in_unit(compared).name), cell});
  }
  if (table.rows.empty()) return "";
  return "<h2 id=\"differences\">Differences</h2>\n<p>Against <b>" + escape(variant_names(runs).front()) +
         "</b>. A difference that is not larger than both error bars together says nothing.</p>\n" + html(table);
}

std::string inputs_part(const std::vector<ComparedRun>& runs) {
  const auto inputs = differing_inputs(runs);
  std::string text = "<h2 id=\"inputs\">Inputs that differ</h2>\n";
  const auto unknown = unknown_inputs_text(runs);
  if (!unknown.empty()) text += "<p>" + escape(unknown) + "</p>\n";
  if (inputs.empty() && !unknown.empty()) return text;
  if (inputs.empty()) return text + "<p>No input differs.</p>\n";
  auto table = variant_table(runs);
  for (const auto& input : inputs) {
    std::vector<std::string> row = {"<code>" + escape(input.key) + "</code>"};
    for (const auto& value : input.values) row.push_back(escape(value));
    table.rows.push_back(std::move(row));
  }
  return text + html(table);
}

std::string cost_part(const std::vector<ComparedRun>& runs) {
  HtmlTable table{.head = {"scene"}, .rows = {}, .css_class = "numbers"};
  std::vector<std::string> stages;
  for (const auto& run : runs)
    for (const auto& [stage, seconds] : run.timings)
      if (std::find(stages.begin(), stages.end(), stage) == stages.end()) stages.push_back(stage);
  for (const auto& stage : stages) table.head.push_back(escape(stage) + ", s");
  for (const char* head : {"peak memory, MB", "results read back", "accuracy wanted", "annulus"})
    table.head.emplace_back(head);
  for (const auto& run : runs) {
    std::vector<std::string> row = {escape(run.name)};
    for (const auto& stage : stages) {
      const auto found =
          std::find_if(run.timings.begin(), run.timings.end(), [&](const auto& t) { return t.first == stage; });
      row.push_back(found == run.timings.end() ? "–" : fmt::format("{:.2f}", found->second));
    }
    row.push_back(fmt::format("{:.0f}", run.peak_memory_MB));
    row.push_back(fmt::format("{}", run.read_back));
    row.push_back(to_text(run.accuracy));
    row.push_back(escape(run.version));
    table.rows.push_back(std::move(row));
  }
  return "<h2 id=\"cost\">Time and memory</h2>\n<p>Wall time of the last run of each scene; results that were read "
         "back from an earlier run cost none.</p>\n" +
         html(table);
}

}  // namespace

std::string comparison_html(const std::vector<ComparedRun>& runs) {
  const auto quantities = compared_quantities(runs);
  std::vector<RingQuantity> plain;
  plain.reserve(quantities.size());
  for (const auto& compared : quantities) plain.push_back(compared.quantity);
  std::string title, scenes;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    title += (i == 0 ? "" : i + 1 == runs.size() ? " and " : ", ") + runs[i].name;
    scenes += "<li><b>" + escape(runs[i].name) + "</b>: " + escape(runs[i].title) + "</li>\n";
  }
  std::string answer = answer_sentences(plain);
  if (answer.empty()) answer = "<p>These runs hold neither stiffness nor load sharing in common.</p>\n";
  return report_page(escape("Comparison of " + title),
                     fmt::format("annulus {} · {} finished runs", version(), runs.size()),
                     "<div class=\"verdict\">\n" + answer + "</div>\n" + answer_picture(plain, variant_names(runs)) +
                         "<ul>" + scenes + "</ul>\n",
                     {{{"figures", "Figures", figures_part(runs, quantities)},
                       {"differences", "Differences", differences_part(runs, quantities)},
                       {"inputs", "Inputs that differ", inputs_part(runs)},
                       {"cost", "Time and memory", cost_part(runs)}}});
}

}  // namespace annulus::app
