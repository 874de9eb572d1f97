#include <fmt/format.h>

#include <algorithm>

#include "app/compare/compared_quantities.h"
#include "app/compare/comparison_page.h"
#include "app/results/content_id.h"
#include "app/sections/report_parts.h"
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
  const auto variants = all_variants(runs);
  const auto quantities = compared_quantities(runs);
  constexpr std::size_t figure_width = 56, least_width = 22;
  std::string text = column("", figure_width);
  for (const auto* variant : variants) text += column(variant->name, std::max(least_width, variant->name.size() + 2));
  text += "\n";
  for (const auto& compared : quantities) {
    const auto quantity = in_unit(compared);
    text += column(quantity.name, figure_width);
    for (const auto* variant : variants) {
      const auto found = std::find_if(quantity.rings.begin(), quantity.rings.end(),
                                      [&](const Measured& m) { return m.ring == variant->name; });
      text += column(found == quantity.rings.end() ? "–" : measured(found->value, found->error),
                     std::max(least_width, variant->name.size() + 2));
    }
    text += "\n";
  }
  text += "\nAgainst " + variants.front()->name + "\n";
  for (const auto& compared : quantities)
    for (const auto& difference : difference_texts(compared))
      text += "  " + in_unit(compared).name + ": " + difference + "\n";
  const auto inputs = differing_inputs(runs);
  const auto unknown = unknown_inputs_text(runs);
  if (!inputs.empty() || unknown.empty()) text += inputs.empty() ? "\nNo input differs.\n" : "\nInputs that differ\n";
  for (const auto& input : inputs) {
    text += "  " + column(input.key, 40);
    for (std::size_t i = 0; i < variants.size(); ++i) text += (i ? " | " : " ") + input.values[i];
    text += "\n";
  }
  if (!unknown.empty()) text += "\n" + unknown + "\n";
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
  for (const auto& compared : compared_quantities(runs)) {
    const auto quantity = in_unit(compared);
    const auto& first = quantity.rings.front();
    for (const auto& m : quantity.rings) {
      const bool other = &m != &first;
      text += csv_cell(compared.spec.title) + "," + compared.spec.unit + "," + csv_cell(m.ring) + "," +
              csv_cell(m.value) + "," + csv_cell(m.error) + "," + (other ? csv_cell(m.value - first.value) : "") + "," +
              (other ? csv_cell(m.error + first.error) : "") + "," +
              (other ? csv_cell(difference_text(first, m, quantity.digits)) : "") + "\n";
    }
  }
  return text;
}

}  // namespace annulus::app
