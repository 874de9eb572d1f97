#include <fmt/format.h>

#include <cmath>

#include "app/scene/overrides.h"
#include "app/sections/report_parts.h"
#include "app/study/study_subject.h"
#include "core/units.h"

namespace annulus::app {

namespace {

std::string known(double value) { return std::isfinite(value) ? to_text(value, 4) : "–"; }

/// Classes in rows, results in columns.
PageTable classes_table(const StudyResults& studies, std::size_t variant) {
  const auto& spectrum = *studies.load_spectrum;
  PageTable table{.head = {"class", "hours", "share of time, %"}, .style = PageTable::Style::numbers};
  for (std::size_t i = 0; i < spectrum.inputs.size(); ++i)
    table.head.emplace_back(with_unit(spectrum.inputs[i], spectrum.units[i]));
  std::vector<const FigureSpec*> shown;
  for (const auto& figure : studies.figures) {
    if (!figure.plotted) continue;
    shown.push_back(&figure);
    table.head.emplace_back(with_unit(figure.title, figure.unit));
  }
  for (std::size_t n = 0; n < spectrum.classes.size(); ++n) {
    const auto& load = spectrum.classes[n];
    std::vector<Text> cells = {load.name, to_text(load.duration / units::hour, 5),
                               fmt::format("{:.3g}", 100 * load.duration / spectrum.duration())};
    for (const double value : load.values) cells.emplace_back(to_text(value, 5));
    for (const auto* figure : shown) {
      const auto text = known(figure->scale * spectrum.variants[variant][n].value(figure->key));
      const auto all = spectrum.overall(variant, figure->key);
      constexpr double rounding = 1e-12;
      const bool differ = all.largest - all.mean > rounding * std::abs(all.largest);
      const bool largest = all.of_class == n && differ;
      cells.push_back(largest ? bold(text) : Text(text));
    }
    table.rows.push_back(std::move(cells));
  }
  std::vector<Text> means = {"mean over the time", to_text(spectrum.duration() / units::hour, 5), "100"};
  means.resize(3 + spectrum.inputs.size(), Text(""));
  for (const auto* figure : shown)
    means.emplace_back(known(figure->scale * spectrum.overall(variant, figure->key).mean));
  table.rows.push_back(std::move(means));
  return table;
}

}  // namespace

Section load_spectrum_section(const StudyResults& studies) {
  Section section{"load-spectrum", "Load spectrum"};
  if (!studies.load_spectrum) return section;
  const auto& spectrum = *studies.load_spectrum;
  StudyOutcome outcome;
  for (const auto& variant : spectrum.variants)
    for (std::size_t n = 0; n < variant.size(); ++n) outcome.add(variant[n], spectrum.classes[n].name);
  section.blocks =
      paragraph(phrase("{} classes of load; all other inputs as in the scene. The largest value of each "
                       "result is bold. Table: {}.{}",
                       spectrum.classes.size(), code("dynamics/load_spectrum.csv"), outcome.text()));
  for (std::size_t variant = 0; variant < studies.variants.size(); ++variant) {
    if (!studies.variants[variant].empty()) section.blocks += heading(studies.variants[variant]);
    section.blocks += classes_table(studies, variant);
  }
  return section;
}

}  // namespace annulus::app
