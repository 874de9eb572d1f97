#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/interactive_plot.h"
#include "app/report/report_parts.h"

namespace annulus::app {

namespace {

std::vector<double> sampled(const VariantSamples& ring, const std::string& figure) {
  const auto column = ring.samples.column(figure), failed = ring.samples.column("failed");
  std::vector<double> values;
  for (const auto& row : ring.samples.rows) {
    if (row[failed] == 0) values.push_back(row[column]);
  }
  return values;
}

std::string spread_picture(const StudyResults& studies, const FigureSpec& figure) {
  SpreadPlot plot{.title = figure.title, .y_label = figure.axis_label()};
  for (std::size_t i = 0; i < studies.variants.size(); ++i) {
    auto values = sampled(studies.monte_carlo->variants[i], figure.key);
    if (values.empty()) continue;
    for (auto& v : values) v *= figure.scale;
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
  return plot_html(plot);
}

std::string percent(const dynamics::Interval& share) {
  return fmt::format("{:.1f} % of the samples ({:.0f} % confidence: {:.1f} to {:.1f} %)", 100 * share.value,
                     100 * dynamics::usual_confidence, 100 * share.low, 100 * share.high);
}

std::string order_sentence(const StudyResults& studies, const PairedOrder& order) {
  if (order.samples == 0) return "";
  // Told from the ring that is more often above.
  const bool swap = 2 * order.above + order.equal < order.samples;
  const long above = swap ? order.samples - order.above - order.equal : order.above;
  const auto share = swap ? dynamics::share_interval(above, order.samples) : order.share;
  const double sign = swap ? -1 : 1, half = order.difference.high - order.difference.value;
  return fmt::format("<li><b>{}</b> lies above <b>{}</b> in {}{}, on average by {}.</li>\n",
                     escape(studies.variants[swap ? order.b : order.a]),
                     escape(studies.variants[swap ? order.a : order.b]), percent(share),
                     order.equal ? fmt::format("; equal in {}", order.equal) : "",
                     std::isfinite(half) ? fmt::format("{:.2g} ± {:.1g}", sign * order.difference.value, half)
                                         : to_text(sign * order.difference.value, 2));
}

std::string bounds(const dynamics::Interval& i, double scale) {
  const auto end = [&](double x) { return std::isfinite(x) ? to_text(scale * x, 5) : std::string("?"); };
  return fmt::format("{} <span class=\"muted\">[{}, {}]</span>", to_text(scale * i.value, 5), end(i.low), end(i.high));
}

HtmlTable statistics_table(const StudyResults& studies) {
  HtmlTable table{
      .head = {"", "mean", "standard deviation", "5 %", "median", "95 %"}, .rows = {}, .css_class = "numbers"};
  for (const auto& figure : studies.figures) {
    if (!figure.spread) continue;
    const std::string title = escape(figure.title + (figure.axis_label().empty() ? "" : ", " + figure.axis_label()));
    const bool named = !studies.variants.front().empty();
    if (named) table.rows.push_back({title});
    for (std::size_t i = 0; i < studies.variants.size(); ++i) {
      const auto* s = studies.monte_carlo->variants[i].find(figure.key);
      if (!s) continue;
      table.rows.push_back({named ? escape(studies.variants[i]) : title, bounds(s->mean, figure.scale),
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
    const std::string with = studies.variants[i].empty() ? "" : " With " + escape(studies.variants[i]) + ",";
    if (samples.failed)
      text += fmt::format("{} {} samples failed and are left out of the statistics.", with, samples.failed);
    if (samples.not_steady)
      text += fmt::format("{} {} samples did not become periodic and count with the window they have.", with,
                          samples.not_steady);
  }
  return text;
}

std::string inputs_text(const MonteCarloResult& samples) {
  std::size_t phases = 0;
  std::string others;
  for (const auto& input : samples.inputs) {
    if (input.find("_phase_deg") != std::string::npos) {
      ++phases;
    } else {
      others += (others.empty() ? "<code>" : ", <code>") + escape(input) + "</code>";
    }
  }
  std::string text = phases ? fmt::format("{} error phases, each anywhere on the circle", phases) : "";
  if (!others.empty()) text += (text.empty() ? "" : ", and ") + others;
  return text;
}

}  // namespace

std::string spread_section(const StudyResults& studies) {
  if (!studies.monte_carlo) return "";
  const auto& samples = *studies.monte_carlo;
  std::string text =
      fmt::format("<h2 id=\"spread\">Spread over what is not known</h2>\n<p>{} samples (seed {}) of {}.{}{}</p>\n",
                  samples.samples, samples.seed, inputs_text(samples),
                  studies.variants.size() > 1 ? " Every ring sees the same samples." : "", counted(studies));
  std::string sentences;
  const auto* ordering = studies.ordering();
  for (const auto& order : samples.orders) {
    if (ordering && order.figure == ordering->key) sentences += order_sentence(studies, order);
  }
  if (!sentences.empty())
    text += "<p>" + escape(ordering->title) + ", sample by sample:</p>\n<ul>" + sentences + "</ul>\n";
  std::vector<std::string> pictures;
  for (const auto& figure : studies.figures) {
    if (figure.spread && figure.plotted) pictures.push_back(spread_picture(studies, figure));
  }
  text +=
      figure(pictures, "",
             "Dots: samples. Box: quartiles and median; whiskers: 5 and 95 %. Diamond: the scene as given, with the "
             "numerical error of its figure.");
  return text +
         fmt::format(
             "<p>In brackets: {:.0f} % confidence intervals, of the mean by Student's t, of quantiles "
             "between order statistics.</p>\n",
             100 * dynamics::usual_confidence) +
         html(statistics_table(studies));
}

}  // namespace annulus::app
