#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report_parts.h"
#include "app/svg_spread.h"

namespace annulus::app {

namespace {

std::vector<double> sampled(const MonteCarloRing& ring, const std::string& figure) {
  const auto column = ring.samples.column(figure), failed = ring.samples.column("failed");
  std::vector<double> values;
  for (const auto& row : ring.samples.rows) {
    if (row[failed] == 0) values.push_back(row[column]);
  }
  return values;
}

struct SpreadFigure {
  std::string title, column;
  dynamics::Figure (*nominal)(const dynamics::DynamicResponse&);
};

double largest_factor(const dynamics::MeshKindResult& kind, double dynamics::Figure::*member) {
  const auto best = std::max_element(kind.branches.begin(), kind.branches.end(), [](const auto& a, const auto& b) {
    return a.dynamic_factor_max.value < b.dynamic_factor_max.value;
  });
  return best->dynamic_factor_max.*member;
}

std::vector<SpreadFigure> spread_figures() {
  using Response = dynamics::DynamicResponse;
  return {{"Load sharing of the sun meshes, averaged", ordering_figure,
           [](const Response& r) { return r.sun_planet.load_sharing.averaged; }},
          {"Load sharing of the ring meshes, averaged", "ring_planet_load_sharing_averaged",
           [](const Response& r) { return r.ring_planet.load_sharing.averaged; }},
          {"Dynamic factor of the sun meshes", "sun_planet_dynamic_factor",
           [](const Response& r) {
             return dynamics::Figure{largest_factor(r.sun_planet, &dynamics::Figure::value),
                                     largest_factor(r.sun_planet, &dynamics::Figure::error)};
           }},
          {"Dynamic factor of the ring meshes", "ring_planet_dynamic_factor", [](const Response& r) {
             return dynamics::Figure{largest_factor(r.ring_planet, &dynamics::Figure::value),
                                     largest_factor(r.ring_planet, &dynamics::Figure::error)};
           }}};
}

std::string spread_picture(const RunResult& result, const SpreadFigure& figure) {
  SpreadPlot plot{.title = figure.title, .y_label = figure.column.ends_with("factor") ? "F / mean force" : "N F / ΣF"};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto& ring = result.studies.monte_carlo->rings[i];
    auto values = sampled(ring, figure.column);
    if (values.empty()) continue;
    const auto quantile = [&](double p) { return dynamics::quantile_interval(values, p).value; };
    SpreadColumn column{.label = result.rings[i].name,
                        .colour = i,
                        .q05 = quantile(0.05),
                        .q25 = quantile(0.25),
                        .median = quantile(0.5),
                        .q75 = quantile(0.75),
                        .q95 = quantile(0.95)};
    if (result.rings[i].response) {
      const auto nominal = figure.nominal(result.rings[i].response->figures);
      column.nominal = nominal.value;
      column.nominal_error = nominal.error;
    } else {
      column.nominal = std::nan("");
    }
    column.values = std::move(values);
    plot.columns.push_back(std::move(column));
  }
  return to_svg(plot);
}

std::string percent(const dynamics::Interval& share) {
  return fmt::format("{:.1f} % of the samples ({:.0f} % confidence: {:.1f} to {:.1f} %)", 100 * share.value,
                     100 * dynamics::usual_confidence, 100 * share.low, 100 * share.high);
}

std::string order_sentence(const RunResult& result, const PairedOrder& order) {
  if (order.samples == 0) return "";
  // Told from the ring that is more often above.
  const bool swap = 2 * order.above + order.equal < order.samples;
  const long above = swap ? order.samples - order.above - order.equal : order.above;
  const auto share = swap ? dynamics::share_interval(above, order.samples) : order.share;
  const double sign = swap ? -1 : 1, half = order.difference.high - order.difference.value;
  return fmt::format("<li><b>{}</b> lies above <b>{}</b> in {}{}, on average by {}.</li>\n",
                     escape(result.rings[swap ? order.b : order.a].name),
                     escape(result.rings[swap ? order.a : order.b].name), percent(share),
                     order.equal ? fmt::format("; equal in {}", order.equal) : "",
                     std::isfinite(half) ? fmt::format("{:.2g} ± {:.1g}", sign * order.difference.value, half)
                                         : to_text(sign * order.difference.value, 2));
}

std::string bounds(const dynamics::Interval& i) {
  const auto end = [](double x) { return std::isfinite(x) ? fmt::format("{:.4f}", x) : std::string("?"); };
  return fmt::format("{:.4f} <span class=\"muted\">[{}, {}]</span>", i.value, end(i.low), end(i.high));
}

HtmlTable statistics_table(const RunResult& result) {
  HtmlTable table{
      .head = {"", "mean", "standard deviation", "5 %", "median", "95 %"}, .rows = {}, .css_class = "numbers"};
  std::vector<std::pair<std::string, std::string>> figures;
  for (const std::string mesh : {"sun", "ring"}) {
    const std::string column = mesh + "_planet_";
    figures.insert(
        figures.end(),
        {{"Load sharing of the " + mesh + " meshes, averaged over a mesh cycle", column + "load_sharing_averaged"},
         {"Load sharing of the " + mesh + " meshes, instantaneous", column + "load_sharing_instantaneous"},
         {"Load sharing of the " + mesh + " meshes, quasi-static", column + "load_sharing_quasi_static"},
         {"Dynamic factor of the " + mesh + " meshes", column + "dynamic_factor"}});
  }
  for (const auto& [label, figure] : figures) {
    table.rows.push_back({label});
    for (std::size_t i = 0; i < result.rings.size(); ++i) {
      const auto* s = result.studies.monte_carlo->rings[i].find(figure);
      if (!s) continue;
      table.rows.push_back({escape(result.rings[i].name), bounds(s->mean), fmt::format("{:.4f}", s->deviation),
                            bounds(s->q05), bounds(s->median), bounds(s->q95)});
    }
  }
  return table;
}

std::string counted(const RunResult& result) {
  std::string text;
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto& ring = result.studies.monte_carlo->rings[i];
    if (ring.failed)
      text += fmt::format(" With {}, {} samples failed and are left out of the statistics.",
                          escape(result.rings[i].name), ring.failed);
    if (ring.not_steady)
      text += fmt::format(" With {}, {} samples did not become periodic and count with the window they have.",
                          escape(result.rings[i].name), ring.not_steady);
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

std::string spread_section(const RunResult& result) {
  if (!result.studies.monte_carlo) return "";
  const auto& samples = *result.studies.monte_carlo;
  std::string text = fmt::format(
      "<h2 id=\"spread\">Spread over what is not known</h2>\n<p>{} samples (seed {}) of {}. Every ring sees the same "
      "samples.{}</p>\n",
      samples.samples, samples.seed, inputs_text(samples), counted(result));
  std::string sentences;
  for (const auto& order : samples.orders) {
    if (order.figure == ordering_figure) sentences += order_sentence(result, order);
  }
  if (!sentences.empty())
    text += "<p>Load sharing of the sun meshes, averaged over a mesh cycle, sample by sample:</p>\n<ul>" + sentences +
            "</ul>\n";
  std::vector<std::string> pictures;
  for (const auto& spread : spread_figures()) pictures.push_back(spread_picture(result, spread));
  text +=
      figure(pictures, "",
             "Dots: samples. Box: quartiles and median; whiskers: 5 and 95 %. Diamond: the scene as given, with the "
             "numerical error of its figure.");
  return text +
         fmt::format(
             "<p>In brackets: {:.0f} % confidence intervals, of the mean by Student's t, of quantiles "
             "between order statistics.</p>\n",
             100 * dynamics::usual_confidence) +
         html(statistics_table(result));
}

}  // namespace annulus::app
