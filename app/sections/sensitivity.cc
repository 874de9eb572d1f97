#include <fmt/format.h>

#include <cmath>

#include "app/sections/report_parts.h"
#include "app/study/study_subject.h"

namespace annulus::app {

namespace {

/// Values of one figure: divided, nominal, multiplied.
std::string three(const SensitivityResult& s, const SensitivityRow& row, std::size_t variant, const std::string& figure,
                  double scale) {
  std::string text;
  for (const auto* point : {&row.divided[variant], &s.nominal[variant], &row.multiplied[variant]}) {
    text += text.empty() ? "" : " / ";
    text += point->failure.empty() ? to_text(scale * point->value(figure), 5) : std::string("failed");
  }
  return text;
}

std::string nominal_values(const SensitivityRow& row) {
  std::string value;
  for (const double v : row.values) {
    const std::string text = std::isfinite(v) ? to_text(v, 5) : "–";
    if (value.empty()) {
      value = text;
    } else if (value != text) {
      value += ", " + text;
    }
  }
  return value + " " + row.unit;
}

}  // namespace

Section sensitivity_section(const StudyResults& studies) {
  Section section{"sensitivity", "Sensitivity"};
  if (!studies.sensitivity) return section;
  const auto& s = *studies.sensitivity;
  const bool compare = studies.variants.size() > 1;
  PageTable table{.head = {"input", "value"}, .style = PageTable::Style::numbers};
  std::vector<const FigureSpec*> shown;
  std::vector<Text> what;
  for (const auto& figure : studies.figures) {
    if (!figure.ordering) continue;
    shown.push_back(&figure);
    what.emplace_back(with_unit(figure.title, figure.axis_label()));
    for (const auto& name : studies.variants) table.head.emplace_back(with_unit(figure.title, name));
  }
  if (compare) table.head.emplace_back("order of the " + studies.variant_word + "s");
  std::size_t same_order = 0;
  for (const auto& row : s.rows) {
    std::vector<Text> cells = {code(row.input), nominal_values(row)};
    for (const auto* figure : shown)
      for (std::size_t variant = 0; variant < studies.variants.size(); ++variant)
        cells.emplace_back(three(s, row, variant, figure->key, figure->scale));
    if (compare)
      cells.push_back(row.order_stays ? tag(Text::Look::agrees, "stays") : tag(Text::Look::disagrees, "changes"));
    same_order += row.order_stays ? 1 : 0;
    table.rows.push_back(std::move(cells));
  }
  section.blocks =
      paragraph(
          phrase("One input at a time is divided by {0}, left unchanged, and multiplied by {0}. {1}.{2}",
                 to_text(s.factor), joined(what, "; "),
                 compare ? fmt::format(" The order of the {}s by the first result stays the same for {} of {} inputs.",
                                       studies.variant_word, same_order, s.rows.size())
                         : "")) +
      table;
  return section;
}

}  // namespace annulus::app
