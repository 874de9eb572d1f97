#include <fmt/format.h>

#include <algorithm>

#include "app/systems/helical_pair/report/pair_report_parts.h"
#include "core/units.h"

namespace annulus::app {

std::string um_text(double x, int digits) { return to_text(1e6 * x, digits); }
std::string torque_text(double x) { return to_text(x / 1e3, 4) + " kN m"; }

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

}  // namespace

std::vector<const ShareRow*> good_rows(const PairRunResult& result) {
  return good(result.shares, &ShareRow::pinion_torque);
}

std::vector<const SpeedRow*> good_speeds(const PairRunResult& result) {
  return good(result.speeds, &SpeedRow::pinion_speed);
}

namespace {

PageTable shares_table(const std::vector<const ShareRow*>& rows) {
  PageTable table{.head = {"torque of the pinion", "peak to peak, all causes", "errors alone", "stiffness alone",
                           "share of the errors", "largest value", "of which mean deflection"},
                  .style = PageTable::Style::numbers};
  const auto add = [&](const ShareRow& row, bool dynamic) {
    const auto& s = row.shares;
    const auto of = [dynamic](const dynamics::PeakToPeak& p) { return dynamic ? p.dynamic : p.quasi_static; };
    table.rows.push_back({torque_text(row.pinion_torque), um_text(of(s.all)), um_text(of(s.errors_alone)),
                          um_text(of(s.stiffness_alone)), fmt::format("{:.0f} %", 100 * of(s.error_share())),
                          um_text(dynamic ? row.largest_dynamic : row.largest_static), um_text(s.load_deflection)});
  };
  table.rows.push_back({"Quasi-static, µm"});
  for (const auto* row : rows) add(*row, false);
  table.rows.push_back({"In motion, µm"});
  for (const auto* row : rows) add(*row, true);
  return table;
}

Pictures shares_pictures(const std::vector<const ShareRow*>& rows) {
  std::vector<double> torque;
  torque.reserve(rows.size());
  for (const auto* row : rows) torque.push_back(row->pinion_torque / 1e3);
  const Range loads{0, 1.04 * torque.back()};
  const auto series = [&](const char* label, std::size_t colour, bool dashed, auto pick) {
    Series s{.label = label, .x = torque, .colour = colour, .dashed = dashed};
    for (const auto* row : rows) s.y.push_back(1e6 * pick(*row));
    return s;
  };
  const auto plot = [&](const char* title, bool dynamic) {
    const auto of = [dynamic](const dynamics::PeakToPeak& p) { return dynamic ? p.dynamic : p.quasi_static; };
    return Plot{.title = title,
                .x_label = "torque of the pinion, kN m",
                .y_label = "peak to peak, µm",
                .x_range = loads,
                .series = {series("all", 0, false, [=](const auto& r) { return of(r.shares.all); }),
                           series("errors", 1, false, [=](const auto& r) { return of(r.shares.errors_alone); }),
                           series("stiffness", 2, false, [=](const auto& r) { return of(r.shares.stiffness_alone); })}};
  };
  Plot largest{
      .title = "Largest value",
      .x_label = "torque of the pinion, kN m",
      .y_label = "µm",
      .x_range = loads,
      .series = {series("largest", 0, false, [](const auto& r) { return r.largest_dynamic; }),
                 series("amplitude", 1, false, [](const auto& r) { return r.shares.errors_alone.quasi_static / 2; }),
                 series("deflection", 5, true, [](const auto& r) { return r.shares.load_deflection; })}};
  return Pictures{{plot("Peak to peak, quasi-static", false), plot("Peak to peak, in motion", true), largest},
                  {{"all causes", 0},
                   {"errors alone (last picture: their amplitude)", 1},
                   {"stiffness alone", 2},
                   {"mean deflection under load", 5}},
                  "Transmission error u₁ + u₂ at the base circles. Causes do not add up: they have phases."};
}

Pictures speeds_pictures(const std::vector<const SpeedRow*>& rows) {
  const auto plot = [&](const char* title, const char* y_label, double SpeedRow::Motion::*pick, double scale) {
    Plot p{.title = title, .x_label = "speed of the pinion, r/min", .y_label = y_label};
    p.x_range = Range{0, 1.04 * rows.back()->pinion_speed / units::rpm};
    std::size_t colour = 0;
    for (const auto cause : {&SpeedRow::all, &SpeedRow::errors_alone, &SpeedRow::stiffness_alone}) {
      Series s{.colour = colour++};
      for (const auto* row : rows) {
        s.x.push_back(row->pinion_speed / units::rpm);
        s.y.push_back(scale * (row->*cause.*pick));
      }
      p.series.push_back(std::move(s));
    }
    return p;
  };
  return Pictures{{plot("Largest acceleration of the teeth", "m/s²", &SpeedRow::Motion::acceleration, 1),
                   plot("Peak-to-peak mesh force", "largest – smallest, kN", &SpeedRow::Motion::force_range, 1e-3),
                   plot("Peak-to-peak transmission error", "µm", &SpeedRow::Motion::te_range, 1e6)},
                  {{"all causes", 0}, {"errors alone", 1}, {"stiffness alone", 2}},
                  "The same causes over speed, at the torque of the stage."};
}

}  // namespace

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
    if (!row.failure.empty())
      failed.items.emplace_back(to_text(row.pinion_speed / units::rpm, 5) + " r/min: " + row.failure);
  if (!failed.items.empty()) section.blocks += paragraph("Left out, for no response was found:") + failed;
  if (!rows.empty()) section.blocks += shares_pictures(rows) + shares_table(rows);
  if (!speeds.empty()) section.blocks += heading("Over speed") + speeds_pictures(speeds);
  return section;
}

}  // namespace annulus::app
