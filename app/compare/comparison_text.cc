#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/compare/compared_quantities.h"
#include "app/compare/comparison_page.h"
#include "app/results/content_id.h"
#include "core/csv.h"

namespace annulus::app {

namespace {

/// Padded by characters, not by bytes.
std::string column(const std::string& text, std::size_t width) {
  const auto characters =
      static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  return text + std::string(characters < width ? width - characters : 1, ' ');
}

}  // namespace

std::string comparison_text(const std::vector<ComparedRun>& runs) {
  const Comparison comparison(runs);
  const auto& variants = comparison.variants;
  constexpr std::size_t name_width = 56, least_width = 22;
  std::string text;
  const auto add_line = [&](const std::string& name, const std::vector<std::string>& cells) {
    text += column(name, name_width);
    for (std::size_t i = 0; i < cells.size(); ++i)
      text += column(cells[i], std::max(least_width, variants[i].size() + 2));
    text += "\n";
  };
  add_line("", variants);
  for (const auto& quantity : comparison.quantities) add_line(quantity.shown.name, quantity.cells);
  text += "\nAgainst " + variants.front() + "\n";
  for (const auto& quantity : comparison.quantities)
    for (const auto& difference : quantity.differences) text += "  " + quantity.shown.name + ": " + difference + "\n";
  if (!comparison.inputs.empty()) text += "\nInputs that differ\n";
  for (const auto& input : comparison.inputs)
    text += fmt::format("  {} {}\n", column(input.key, 40), fmt::join(input.values, " | "));
  if (!comparison.inputs_remark.empty()) text += "\n" + comparison.inputs_remark + "\n";
  text += "\n";
  for (const auto& run : runs) {
    double total = 0;
    for (const auto& [stage, seconds] : run.timings)
      if (stage == "total") total = seconds;
    text += column("cost    " + run.name, 40) +
            fmt::format("{:.2f} s, {:.0f} MB{}\n", total, run.peak_memory_MB,
                        run.read_back > 0 ? fmt::format(", {} results read back", run.read_back) : "");
  }
  return text;
}

std::string comparison_csv(const std::vector<ComparedRun>& runs) {
  std::string text = fmt::format("# annulus_version: {}\n# kind: {}\n", version(), runs.front().kind);
  for (const auto& run : runs) text += "# run: " + run.name + " = " + run.folder.string() + "\n";
  text += "figure,unit,variant,value,error,difference_to_first,errors_together,against_first\n";
  for (const auto& [spec, si, shown, cells, differences] : Comparison(runs).quantities) {
    const auto& first = shown.rings.front();
    for (const auto& m : shown.rings) {
      text += fmt::format("{},{},{},{},{},", csv_cell(spec->title), spec->unit, csv_cell(m.ring), csv_cell(m.value),
                          csv_cell(m.error));
      text += &m == &first ? ",,\n"
                           : fmt::format("{},{},{}\n", csv_cell(m.value - first.value), csv_cell(m.error + first.error),
                                         csv_cell(difference_text(first, m, shown.digits)));
    }
  }
  return text;
}

}  // namespace annulus::app
