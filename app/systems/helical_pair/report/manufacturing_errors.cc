#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/report/pair_report_parts.h"

namespace annulus::app {

namespace {

std::string micrometre_text(double x) { return std::isfinite(x) ? fmt::format("{:.3f}", 1e6 * x) : "–"; }

/// Draws of the pinion's envelope against what the law lets expect.
Pictures histogram_picture(const PairRunResult& result) {
  const auto& h = result.errors.law->histogram;
  const auto& reading = result.errors.law->amplitude();
  Plot plot = wide_plot("Amplitude of the pinion's error, √(X₁² + X₂²)", "µm",
                        fmt::format("draws of {} per bin", result.errors.problem->samples), 340);
  plot.legend = false;
  // Steps with the area below them shaded: a histogram.
  Series drawn{.label = "drawn", .colour = 0}, law{.label = "exact law", .colour = 1};
  double top = 0;
  for (std::size_t i = 0; i < h.count.size(); ++i) {
    const double x = 1e6 * h.width * (static_cast<double>(i) + 0.5), half = 0.5e6 * h.width;
    for (const double edge : {x - half, x + half}) {
      drawn.x.push_back(edge);
      drawn.y.push_back(h.count[i]);
      drawn.low.push_back(0);
      drawn.high.push_back(h.count[i]);
    }
    law.x.push_back(x);
    law.y.push_back(h.expected[i]);
    top = std::max({top, static_cast<double>(h.count[i]), h.expected[i]});
  }
  const double q = 1e6 * reading.sample.value;
  plot.series = {drawn, law, {.label = "quantile", .x = {q, q}, .y = {0, 0.75 * top}, .colour = 5, .dashed = true}};
  // Beside the line, where the histogram is low; a note ends at its position.
  plot.notes.push_back(
      {q + 0.27 * drawn.x.back(), 0.72 * top,
       fmt::format("{:.0f} % of the draws lie below {:.2f} µm", 100 * result.errors.problem->probability, q)});
  return {{plot},
          {{"drawn", 0}, {"exact law (its square is hypoexponential)", 1}, {"quantile of the draws", 5}},
          phrase("The error of the pinion over a turn is T = X₁ sin θ + X₂ sin zθ with Rayleigh-distributed "
                 "amplitudes. The histogram shows the amplitude of its envelope from gear to gear. Tables: {}, {}.",
                 code("errors/samples.csv"), code("errors/histogram.csv"))};
}

}  // namespace

Section pair_errors_section(const PairRunResult& result) {
  Section section{"errors", "Manufacturing errors"};
  if (!result.errors.law) return section;
  const auto& problem = *result.errors.problem;
  const auto& readings = result.errors.law->readings;
  const auto* taken = result.errors.taken(result.scene);
  const auto is_outside = [](const auto& r) { return r.exact < r.sample.low || r.exact > r.sample.high; };
  auto& blocks = section.blocks;
  blocks = paragraph(fmt::format(
               "{} draws per gear, seed {}. Scales of the Rayleigh laws with the divisor {}: η₁ = {:.3f} µm (once per "
               "turn) and η₂ = {:.3f} µm (once per tooth) for the pinion, {:.3f} and {:.3f} µm for the wheel.",
               problem.samples, problem.seed, to_text(problem.divisor, 5), 1e6 * problem.eta_1(0),
               1e6 * problem.eta_2(0), 1e6 * problem.eta_1(1), 1e6 * problem.eta_2(1))) +
           histogram_picture(result) + heading(fmt::format("Meanings of “{:.4g} %”", 100 * problem.probability)) +
           paragraph(fmt::format(
               "The same law has many quantiles at {:.4g} %, one for each quantity. The sample quantile has a "
               "distribution-free interval at {:.4g} % confidence. The exact quantile is that of the law.",
               100 * problem.probability, 100 * problem.confidence));
  PageTable table{.head = {"reading", "of", "draws, µm", "interval, µm", "exact, µm", ""}};
  for (const auto& r : readings)
    table.rows.push_back({code(r.name), r.quantity, micrometre_text(r.sample.value),
                          micrometre_text(r.sample.low) + " … " + micrometre_text(r.sample.high),
                          micrometre_text(r.exact) + (is_outside(r) ? " " + muted("outside") : Text()),
                          taken == &r ? tag(Text::Look::agrees, "applied") : Text()});
  blocks += table;
  blocks +=
      paragraph(fmt::format("{} of {} exact values lie outside their intervals. At this confidence, {:.1f} are "
                            "expected if the readings are independent. The readings of one gear are not independent.",
                            std::count_if(readings.begin(), readings.end(), is_outside), readings.size(),
                            (1 - problem.confidence) * static_cast<double>(readings.size())));
  if (!taken)
    blocks += paragraph(fmt::format("No reading is applied: the scene prescribes {} µm at mesh frequency.",
                                    to_text(1e6 * result.errors.amplitude, 5)));
  else
    blocks += paragraph(
        phrase("The {} quantile of {}, {} µm, is the amplitude of the error at mesh frequency in the dynamics.",
               helical_pair(result.scene).manufacturing_error->amount == ErrorAmount::sample ? "drawn" : "exact",
               code(taken->name), micrometre_text(result.errors.amplitude)));
  return section;
}

}  // namespace annulus::app
