#include <fmt/format.h>

#include <algorithm>

#include "app/systems/helical_pair/report/pair_report_parts.h"
#include "core/units.h"

namespace annulus::app {

std::string um_text(double x, int digits) { return to_text(1e6 * x, digits); }
std::string torque_text(double x) { return to_text(x / 1e3, 4) + " kN m"; }
std::string speed_text(double x) { return to_text(x / units::rpm, 5) + " r/min"; }

namespace {

/// The rows without a failure, by rising value of a member.
template <class Row>
std::vector<const Row*> good(const std::vector<Row>& all, double Row::*rising) {
  std::vector<const Row*> rows;
  for (const auto& row : all)
    if (row.failure.empty()) rows.push_back(&row);
  std::sort(rows.begin(), rows.end(), [rising](const Row* a, const Row* b) { return a->*rising < b->*rising; });
  return rows;
}

using PeakToPeakPart = double dynamics::PeakToPeak::*;
constexpr PeakToPeakPart still = &dynamics::PeakToPeak::quasi_static, moving = &dynamics::PeakToPeak::dynamic;

double largest(const ShareRow& row, PeakToPeakPart part) {
  return part == moving ? row.largest_dynamic : row.largest_static;
}

PageTable shares_table(const std::vector<const ShareRow*>& rows) {
  PageTable table{.head = {"torque of the pinion", "peak to peak, all causes", "errors alone", "stiffness alone",
                           "share of the errors", "largest value", "of which mean deflection"},
                  .style = PageTable::Style::numbers};
  for (const auto& [head, part] : {std::pair{"Quasi-static, µm", still}, {"In motion, µm", moving}}) {
    table.rows.push_back({head});
    for (const auto* row : rows) {
      const auto& s = row->shares;
      table.rows.push_back({torque_text(row->pinion_torque), um_text(s.all.*part), um_text(s.errors_alone.*part),
                            um_text(s.stiffness_alone.*part), fmt::format("{:.0f} %", 100 * s.error_share().*part),
                            um_text(largest(*row, part)), um_text(s.load_deflection)});
    }
  }
  return table;
}

/// A line over the rows, from zero on the x axis.
template <class Row>
struct CauseLine {
  std::size_t colour;
  std::function<double(const Row&)> value;
  bool dashed = false;
};
template <class Row>
Plot cause_plot(Plot plot, const std::vector<const Row*>& rows, double Row::*x, double x_unit, double y_scale,
                const std::vector<CauseLine<Row>>& lines) {
  plot.x_range = Range{0, 1.04 * rows.back()->*x / x_unit};
  for (const auto& line : lines) {
    Series series{.colour = line.colour, .dashed = line.dashed};
    for (const auto* row : rows) {
      series.x.push_back(row->*x / x_unit);
      series.y.push_back(y_scale * line.value(*row));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Pictures shares_pictures(const std::vector<const ShareRow*>& rows) {
  const auto plot = [&](const char* title, const char* y_label, const std::vector<CauseLine<ShareRow>>& lines) {
    return cause_plot<ShareRow>({.title = title, .x_label = "torque of the pinion, kN m", .y_label = y_label}, rows,
                                &ShareRow::pinion_torque, 1e3, 1e6, lines);
  };
  const auto causes = [](PeakToPeakPart part) {
    return std::vector<CauseLine<ShareRow>>{{0, [=](const ShareRow& r) { return r.shares.all.*part; }},
                                            {1, [=](const ShareRow& r) { return r.shares.errors_alone.*part; }},
                                            {2, [=](const ShareRow& r) { return r.shares.stiffness_alone.*part; }}};
  };
  return Pictures{
      {plot("Peak to peak, quasi-static", "peak to peak, µm", causes(still)),
       plot("Peak to peak, in motion", "peak to peak, µm", causes(moving)),
       plot("Largest value", "µm",
            {{0, [](const ShareRow& r) { return r.largest_dynamic; }},
             {1, [](const ShareRow& r) { return r.shares.errors_alone.quasi_static / 2; }},
             {5, [](const ShareRow& r) { return r.shares.load_deflection; }, true}})},
      {{"all causes", 0},
       {"errors alone (last picture: their amplitude)", 1},
       {"stiffness alone", 2},
       {"mean deflection under load", 5}},
      "Transmission error u₁ + u₂ at the base circles. The causes do not add up, because their phases differ."};
}

Pictures speeds_pictures(const std::vector<const SpeedRow*>& rows) {
  const auto plot = [&](const char* title, const char* y_label, double SpeedRow::Motion::*pick, double scale) {
    std::vector<CauseLine<SpeedRow>> lines;
    for (const auto cause : {&SpeedRow::all, &SpeedRow::errors_alone, &SpeedRow::stiffness_alone})
      lines.push_back({lines.size(), [=](const SpeedRow& row) { return row.*cause.*pick; }});
    return cause_plot<SpeedRow>({.title = title, .x_label = "speed of the pinion, r/min", .y_label = y_label}, rows,
                                &SpeedRow::pinion_speed, units::rpm, scale, lines);
  };
  return Pictures{
      {plot("Largest acceleration of the teeth", "m/s²", &SpeedRow::Motion::acceleration, 1),
       plot("Peak-to-peak mesh force", "largest – smallest, kN", &SpeedRow::Motion::peak_to_peak_force, 1e-3),
       plot("Peak-to-peak transmission error", "µm", &SpeedRow::Motion::peak_to_peak_te, 1e6)},
      {{"all causes", 0}, {"errors alone", 1}, {"stiffness alone", 2}},
      "The same causes over the speed, at the torque of the stage."};
}

}  // namespace

std::vector<const ShareRow*> good_rows(const PairRunResult& result) {
  return good(result.shares, &ShareRow::pinion_torque);
}

std::vector<const SpeedRow*> good_speeds(const PairRunResult& result) {
  return good(result.speeds, &SpeedRow::pinion_speed);
}

Section pair_shares_section(const PairRunResult& result) {
  Section section{"shares", "Causes of the transmission error"};
  const auto rows = good_rows(result);
  const auto speeds = good_speeds(result);
  if (rows.empty() && speeds.empty()) return section;
  section.blocks =
      paragraph("Errors alone: at constant mean stiffness; stiffness alone: without manufacturing errors. Table: " +
                code("dynamics/transmission_error_shares.csv") + ".");
  List failed;
  for (const auto& row : result.shares)
    if (!row.failure.empty()) failed.items.emplace_back(torque_text(row.pinion_torque) + ": " + row.failure);
  for (const auto& row : result.speeds)
    if (!row.failure.empty()) failed.items.emplace_back(speed_text(row.pinion_speed) + ": " + row.failure);
  if (!failed.items.empty()) section.blocks += paragraph("Left out, because no response was found:") + failed;
  if (!rows.empty()) section.blocks += shares_pictures(rows) + shares_table(rows);
  if (!speeds.empty()) section.blocks += heading("Over speed") + speeds_pictures(speeds);
  return section;
}

}  // namespace annulus::app
