#include "app/results/figure_table.h"

#include <fmt/format.h>

#include <cmath>

#include "app/results/content_id.h"
#include "core/csv.h"
#include "core/readable_unit.h"

namespace annulus::app {

namespace {

std::string number_cell(double x) { return std::isfinite(x) ? fmt::format("{:.17g}", x) : ""; }

}  // namespace

std::string figures_csv(const std::vector<FigureSpec>& specs, const std::vector<VariantFigures>& variants) {
  std::string text = fmt::format(
      "# annulus_version: "
      "{}\nvariant,key,symbol,value,error,quantile_05,median,quantile_95,shown_value,shown_error,unit,title\n",
      version());
  for (const auto& variant : variants)
    for (const auto& spec : specs) {
      const auto* entry = variant.figures.find(spec.key);
      if (!entry) continue;
      const auto& f = entry->figure;
      const auto shown = readable_unit({spec.unit, spec.scale}, {f.value});
      const auto s = entry->spread.value_or(Spread{not_known, not_known, not_known});
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_cell(variant.name), spec.key, spec.symbol,
                          number_cell(f.value), number_cell(f.error), number_cell(s.low), number_cell(s.median),
                          number_cell(s.high), number_cell(shown.scale * f.value), number_cell(shown.scale * f.error),
                          shown.unit, csv_cell(spec.title));
    }
  return text;
}

std::string explain(const FigureSpec& spec, const std::vector<std::string>& kinds) {
  std::string text =
      fmt::format("{}\n  {}{}\n", spec.key, spec.title, spec.symbol.empty() ? "" : " (" + spec.symbol + ")");
  if (!spec.definition.empty()) text += "  definition: " + spec.definition + "\n";
  if (!spec.unit.empty()) text += "  shown in:   " + spec.unit + "\n";
  if (spec.better != Better::neither)
    text += fmt::format("  better:     {}\n", spec.better == Better::smaller ? "smaller" : "larger");
  std::string names;
  for (const auto& kind : kinds) names += (names.empty() ? "" : ", ") + kind;
  return text + "  a result of " + names + "\n";
}

}  // namespace annulus::app
