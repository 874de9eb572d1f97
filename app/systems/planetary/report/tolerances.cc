#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/report/stage_report_parts.h"

namespace annulus::app {

namespace {

/// The quantiles over the torque, with the intervals of the finite number of draws.
Picture over_torque(const RingResult& ring, const std::optional<TabulatedSharing>& tabulated, double highest) {
  const auto& sharing = ring.tolerances->sharing;
  Plot plot{.title = ring.name,
            .x_label = "torque, share of that of the stage",
            .y_label = "K_γ",
            .y_range = Range{1, highest}};
  std::size_t colour = 0;
  for (const auto& shown : sharing_quantiles()) {
    Series line{.label = shown.share, .x = sharing.torque_shares, .colour = colour++};
    for (const auto& q : sharing.quantiles) {
      const auto& interval = q.*shown.interval;
      line.y.push_back(interval.value);
      line.low.push_back(interval.low);
      line.high.push_back(std::isfinite(interval.high) ? interval.high : interval.value);
    }
    plot.series.push_back(std::move(line));
  }
  if (tabulated) {
    plot.levels.emplace_back(tabulated->low, "tabulated");
    if (tabulated->high > tabulated->low) plot.levels.emplace_back(tabulated->high, "");
  }
  Picture picture(plot);
  picture.variant = ring.name;
  return picture;
}

PageTable quantiles_table(const RingResult& ring, const std::optional<TabulatedSharing>& tabulated) {
  PageTable table{.head = {"torque, share"}, .style = PageTable::Style::numbers};
  for (const auto& shown : sharing_quantiles()) table.head.emplace_back(fmt::format("K_γ {}", shown.symbol));
  if (tabulated) table.head.emplace_back(fmt::format("tabulated for {} planets", tabulated->planets));
  const auto& sharing = ring.tolerances->sharing;
  for (std::size_t i = 0; i < sharing.torque_shares.size(); ++i) {
    auto& row = table.rows.emplace_back(1, to_text(sharing.torque_shares[i], 3));
    for (const auto& shown : sharing_quantiles())
      row.emplace_back(measured(ring.tolerances->figure(shown.interval, i), 1));
    if (tabulated) row.emplace_back(text(*tabulated));
  }
  return table;
}

PageTable contributions_table(const RingResult& ring) {
  PageTable table{.head = {"tolerance", "K_γ P95 with this one alone", "without it", "share it adds to P95 − 1"},
                  .style = PageTable::Style::numbers};
  const auto& sharing = ring.tolerances->sharing;
  const double all = sharing.quantiles[sharing.nominal()].p95.value;
  auto sorted = sharing.contributions;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.without.p95.value < b.without.p95.value; });
  for (const auto& c : sorted)
    table.rows.push_back({tolerance_text(c), fmt::format("{:.3f}", c.alone.p95.value),
                          fmt::format("{:.3f}", c.without.p95.value),
                          all > 1 ? fmt::format("{:.0f} %", 100 * (all - c.without.p95.value) / (all - 1)) : "–"});
  return table;
}

}  // namespace

Section tolerances_section(const RunResult& result) {
  Section section{
      "tolerances", "Load sharing within the tolerances", {}, "Load sharing of assemblies within the tolerances"};
  if (!planetary(result.scene).tolerances || responses_of(result).empty()) return section;
  const auto& t = *planetary(result.scene).tolerances;
  const auto tabulated = tabulated_sharing(result.scene.stage.planets);
  section.blocks = paragraph(fmt::format(
      "{} assemblies (seed {}), {} distributed within their zones, in quasi-static equilibrium. K_γ is the largest "
      "over "
      "planets and error period, with the forces averaged over a mesh cycle. 95 % of the assemblies stay below P95.",
      t.assemblies, t.seed, t.distribution == ToleranceLaw::normal ? "normally" : "uniformly"));
  double highest = tabulated ? tabulated->high : 1;
  for (const auto& ring : result.rings)
    for (const auto& q : ring.tolerances->sharing.quantiles)
      highest = std::max({highest, q.p99.value, std::isfinite(q.p99.high) ? q.p99.high : 1});
  highest = 1 + 1.06 * (highest - 1);
  Pictures pictures{.caption = "Bands: 95 % confidence intervals for the number of assemblies."};
  for (std::size_t i = 0; i < sharing_quantiles().size(); ++i)
    pictures.legend.emplace_back(fmt::format("{} of the assemblies", sharing_quantiles()[i].share), i);
  for (const auto& ring : result.rings) pictures.list.push_back(over_torque(ring, tabulated, highest));
  section.blocks += pictures;
  for (const auto& ring : result.rings) {
    if (result.rings.size() > 1) section.blocks += heading(ring.name);
    section.blocks += quantiles_table(ring, tabulated) + contributions_table(ring);
  }
  std::string notes =
      "The contributions hold at the torque of the stage. They do not add up to 100 %: deviations combine as squares "
      "rather than as sums.";
  if (tabulated)
    notes +=
        " Tabulated: load-sharing factors of standards, by class of tolerance. The standards disagree, and know "
        "neither the supports nor the ring of this stage.";
  section.blocks += paragraph(notes);
  return section;
}

}  // namespace annulus::app
