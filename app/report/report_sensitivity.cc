#include <fmt/format.h>

#include <cmath>

#include "app/report/report_parts.h"
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

std::string sensitivity_section(const StudyResults& studies) {
  if (!studies.sensitivity) return "";
  const auto& s = *studies.sensitivity;
  const bool compare = studies.variants.size() > 1;
  HtmlTable table{.head = {"input", "value"}, .rows = {}, .css_class = "numbers"};
  std::vector<const FigureSpec*> shown;
  std::string what;
  for (std::size_t i = 0; i < studies.figures.size(); ++i) {
    const auto& figure = studies.figures[i];
    if (!figure.ordering) continue;
    shown.push_back(&figure);
    what += (what.empty() ? "" : "; ") +
            escape(figure.title + (figure.axis_label().empty() ? "" : " (" + figure.axis_label() + ")"));
    for (const auto& name : studies.variants)
      table.head.push_back(escape(figure.title + (name.empty() ? "" : ", " + name)));
  }
  if (compare) table.head.emplace_back("order of the rings");
  std::size_t kept = 0;
  for (const auto& row : s.rows) {
    std::vector<std::string> cells = {"<code>" + escape(row.input) + "</code>", nominal_values(row)};
    for (const auto* figure : shown) {
      for (std::size_t variant = 0; variant < studies.variants.size(); ++variant)
        cells.push_back(three(s, row, variant, figure->key, figure->scale));
    }
    if (compare)
      cells.emplace_back(row.order_stays ? "<span class=\"tag agrees\">stays</span>"
                                         : "<span class=\"tag disagrees\">changes</span>");
    kept += row.order_stays ? 1 : 0;
    table.rows.push_back(std::move(cells));
  }
  std::string text = fmt::format(
      "<h2 id=\"sensitivity\">Sensitivity</h2>\n<p>Each input divided by {0}, as it is, and multiplied by {0}, one at "
      "a time. {1}.",
      to_text(s.factor), what);
  if (compare)
    text += fmt::format(" The order of the rings by the first figure stays for {} of {} inputs.", kept, s.rows.size());
  return text + "</p>\n<div class=\"wide\">" + html(table) + "</div>\n";
}

}  // namespace annulus::app
