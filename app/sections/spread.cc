#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/sections/report_parts.h"

namespace annulus::app {

namespace {

/// The shown values of the samples that did not fail.
std::vector<double> sampled(Csv samples, const FigureSpec& figure) {
  std::erase_if(samples.rows, [failed = samples.column("failed")](const auto& row) { return row[failed] != 0; });
  return column_values(samples, figure.key, 1e99, figure.scale);
}

SpreadPlot spread_picture(const StudyResults& studies, const FigureSpec& figure) {
  SpreadPlot plot{.title = figure.title, .y_label = figure.axis_label()};
  for (std::size_t i = 0; i < studies.variants.size(); ++i) {
    auto values = sampled(studies.monte_carlo->variants[i].samples, figure);
    if (values.empty()) continue;
    const auto quantile = [&](double p) { return dynamics::quantile_interval(values, p).value; };
    SpreadColumn column{.label = studies.variants[i],
                        .colour = i,
                        .q05 = quantile(0.05),
                        .q25 = quantile(0.25),
                        .median = quantile(0.5),
                        .q75 = quantile(0.75),
                        .q95 = quantile(0.95)};
    const auto nominal = studies.nominal[i].figure(figure.key);
    column.nominal = figure.scale * nominal.value;
    column.nominal_error = std::isfinite(nominal.error) ? figure.scale * nominal.error : 0;
    column.values = std::move(values);
    plot.columns.push_back(std::move(column));
  }
  return plot;
}

std::string percent(const dynamics::Interval& share) {
  return fmt::format("{:.1f} % of the samples ({:.0f} % confidence: {:.1f} to {:.1f} %)", 100 * share.value,
                     100 * dynamics::usual_confidence, 100 * share.low, 100 * share.high);
}

/// Nothing when there are no pairs.
std::optional<Text> order_sentence(const StudyResults& studies, const PairedOrder& order) {
  if (order.samples == 0) return std::nullopt;
  // Seen from the variant that is more often above.
  const bool swap = 2 * order.above + order.equal < order.samples;
  const long above = swap ? order.samples - order.above - order.equal : order.above;
  const auto share = swap ? dynamics::share_interval(above, order.samples) : order.share;
  const double sign = swap ? -1 : 1, half = order.difference.high - order.difference.value;
  return phrase("{} lies above {} in {}{}, on average by {}.", bold(studies.variants[swap ? order.b : order.a]),
                bold(studies.variants[swap ? order.a : order.b]), percent(share),
                order.equal ? fmt::format("; equal in {}", order.equal) : "",
                std::isfinite(half) ? fmt::format("{:.2g} ± {:.1g}", sign * order.difference.value, half)
                                    : to_text(sign * order.difference.value, 2));
}

Text bounds(const dynamics::Interval& i, double scale) {
  const auto end = [&](double x) { return std::isfinite(x) ? to_text(scale * x, 5) : std::string("?"); };
  return to_text(scale * i.value, 5) + " " + muted("[" + end(i.low) + ", " + end(i.high) + "]");
}

PageTable statistics_table(const StudyResults& studies) {
  PageTable table{.head = {"", "mean", "standard deviation", "5 %", "median", "95 %"},
                  .style = PageTable::Style::numbers};
  for (const auto& figure : studies.figures) {
    if (!figure.spread) continue;
    const std::string title = with_unit(figure.title, figure.axis_label());
    const bool named = !studies.variants.front().empty();
    if (named) table.rows.push_back({title});
    for (std::size_t i = 0; i < studies.variants.size(); ++i) {
      const auto* s = studies.monte_carlo->variants[i].find(figure.key);
      if (!s) continue;
      table.rows.push_back({named ? studies.variants[i] : title, bounds(s->mean, figure.scale),
                            to_text(figure.scale * s->deviation, 5), bounds(s->q05, figure.scale),
                            bounds(s->median, figure.scale), bounds(s->q95, figure.scale)});
    }
  }
  return table;
}

std::string counted(const StudyResults& studies) {
  std::string text;
  for (std::size_t i = 0; i < studies.variants.size(); ++i) {
    const auto& samples = studies.monte_carlo->variants[i];
    const auto found = StudyOutcome{studies.monte_carlo->samples, samples.failed, samples.not_steady}.text();
    if (!found.empty()) text += (studies.variants[i].empty() ? "" : " " + studies.variants[i] + ":") + found;
  }
  return text;
}

Text inputs_text(const MonteCarloResult& samples) {
  std::size_t phases = 0;
  std::vector<Text> others;
  for (const auto& input : samples.inputs) {
    if (input.find("_phase_deg") != std::string::npos)
      ++phases;
    else
      others.push_back(code(input));
  }
  Text text = phases ? fmt::format("{} error phases, each uniform over the circle", phases) : "";
  if (!others.empty()) text += (text.empty() ? "" : ", and ") + joined(others, ", ");
  return text;
}

}  // namespace

Section spread_section(const StudyResults& studies) {
  Section section{"spread", "Spread", {}, "Spread over unknown inputs"};
  if (!studies.monte_carlo) return section;
  const auto& samples = *studies.monte_carlo;
  section.blocks = paragraph(
      phrase("{} samples (seed {}) of {}.{}{}", samples.samples, samples.seed, inputs_text(samples),
             studies.variants.size() > 1 ? fmt::format(" All {}s have the same samples.", studies.variant_word) : "",
             counted(studies)));
  List sentences;
  const auto* ordering = studies.ordering();
  for (const auto& order : samples.orders) {
    if (!ordering || order.figure != ordering->key) continue;
    if (const auto sentence = order_sentence(studies, order)) sentences.items.push_back(*sentence);
  }
  if (!sentences.items.empty()) section.blocks += paragraph(ordering->title + ", sample by sample:") + sentences;
  section.blocks +=
      Pictures{result_pictures(studies,
                               [&](const FigureSpec& figure) {
                                 return figure.spread ? std::optional(spread_picture(studies, figure)) : std::nullopt;
                               }),
               {},
               "Dots: samples. Box: quartiles and median. Whiskers: 5 % and 95 %. Diamond: nominal inputs with the "
               "numerical error."};
  section.blocks += paragraph(fmt::format("In brackets: {:.0f} % confidence intervals. That of the mean follows from "
                                          "Student's t distribution, those of quantiles follow from order statistics.",
                                          100 * dynamics::usual_confidence)) +
                    statistics_table(studies);
  return section;
}

}  // namespace annulus::app
