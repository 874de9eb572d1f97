#include "app/tradeoff/trade_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/plan/cost_plan.h"
#include "app/report/page.h"
#include "app/report/plot/chart.h"
#include "app/results/content_id.h"
#include "app/scene/overrides.h"
#include "app/sections/report_parts.h"
#include "core/csv.h"
#include "core/files.h"

namespace annulus::app {

namespace {

constexpr double wanted_accuracies[] = {0.1, 0.01, 0.001};

constexpr TradePart both_parts[] = {TradePart::mesh, TradePart::dynamics};
const char* part_name(TradePart part) { return part == TradePart::mesh ? "mesh" : "dynamics"; }
const char* part_title(TradePart part) { return part == TradePart::mesh ? "Stiffness tables" : "Dynamics"; }
/// "held, stiffness tables"
std::string part_of(const VariantTrade& variant, TradePart part) {
  return variant.name + (part == TradePart::mesh ? ", stiffness tables" : ", dynamics");
}

std::string percent(double share) { return to_text(100 * share, 2) + " %"; }

std::string setting_text(const TradePoint& p) { return p.fidelity + ", " + p.settings; }

/// "For 1 %: plane, degree 2, level 1, 0.3 s, 240 MB (worst: ...)".
std::string cheapest_text(const VariantTrade& variant, TradePart part, double accuracy) {
  const auto* p = variant.cheapest(part, accuracy);
  if (!p) return fmt::format("For {}: only the finest setting.", percent(accuracy));
  return fmt::format("For {}: {}; {}, {:.0f} MB; errors up to {} ({}).", percent(accuracy), setting_text(*p),
                     duration_text(p->cost.wall), p->cost.peak_memory_MB, percent(p->error()),
                     variant.title(p->worst()->key));
}

/// "The planner, asked for 1 %: 3.1 s, 400 MB; errors up to 0.2 % (...)".
std::string planned_text(const VariantTrade& variant, const TradePoint& p) {
  const std::string text = fmt::format("The planner for {}: ", percent(*p.planned_for));
  if (!p.failure.empty()) return text + p.failure;
  const auto* worst = variant.worst_guaranteed(p);
  std::string others;
  for (const auto* value : variant.not_guaranteed(p))
    others += fmt::format("{}{} {}", others.empty() ? "" : ", ", variant.title(value->key), percent(value->error));
  return text + fmt::format("{}, {:.0f} MB; errors up to {}{}.{}", duration_text(p.cost.wall), p.cost.peak_memory_MB,
                            percent(variant.guaranteed_error(p)), worst ? " (" + variant.title(worst->key) + ")" : "",
                            others.empty() ? "" : " Not covered by the accuracy: " + others + ".");
}

/// Both for all accuracies.
std::vector<std::string> cheapest_texts(const VariantTrade& variant, TradePart part) {
  std::vector<std::string> texts;
  for (const double accuracy : wanted_accuracies) texts.push_back(cheapest_text(variant, part, accuracy));
  for (const auto* p : variant.of(part))
    if (p->planned_for) texts.push_back(planned_text(variant, *p));
  return texts;
}

const TradePoint* finest_of(const VariantTrade& variant, TradePart part) {
  for (const auto* p : variant.of(part))
    if (p->finest) return p;
  return nullptr;
}

Plot errors_plot(const std::string& title, const std::string& y_label, int height) {
  Plot plot{.title = title, .x_label = "wall time, s", .y_label = y_label, .width = 640, .height = height};
  plot.x_log = plot.y_log = plot.legend = true;
  return plot;
}

/// The cheapest setting for every figure and accuracy: what a user asks who wants one thing.
PageTable cheapest_table(const VariantTrade& variant, TradePart part) {
  PageTable table{.head = {"result"}};
  for (const double accuracy : wanted_accuracies) table.head.emplace_back(percent(accuracy));
  for (const auto& figure : variant.figures) {
    if (variant.front(part, figure.key).empty()) continue;
    std::vector<Text> row = {figure.title};
    for (const double accuracy : wanted_accuracies) {
      const auto* p = variant.cheapest(part, accuracy, figure.key);
      row.push_back(p ? setting_text(*p) + " " + muted(duration_text(p->cost.wall)) : Text("only the finest"));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The front of every figure.
Plot fronts_plot(const VariantTrade& variant, TradePart part) {
  Plot plot = errors_plot("The front of every result", "error", 460);
  for (std::size_t f = 0; f < variant.figures.size(); ++f) {
    const auto& figure = variant.figures[f];
    Series series{.label = figure.title, .colour = f};
    for (const auto* p : variant.front(part, figure.key)) {
      if (!(p->error(figure.key) > 0)) continue;
      series.x.push_back(p->cost.wall);
      series.y.push_back(p->error(figure.key));
    }
    if (!series.x.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

/// How far the program's own estimates are from the errors, over all figures with both.
Blocks estimates_text(const VariantTrade& variant, TradePart part) {
  int within = 0, all = 0;
  for (const auto* p : variant.of(part)) {
    if (p->finest || p->changes_model || !p->failure.empty()) continue;
    for (const auto& v : p->values) {
      if (!std::isfinite(v.error) || !std::isfinite(v.error_estimate)) continue;
      ++all;
      within += v.error <= v.error_estimate;
    }
  }
  if (all == 0) return {};
  return paragraph(fmt::format("{} of {} errors lie within their own estimates.", within, all));
}

PageTable points_table(const VariantTrade& variant, TradePart part) {
  PageTable table{.head = {"model", "setting", "wall", "processor", "memory", "largest error", "result"},
                  .style = PageTable::Style::numbers};
  const auto front = variant.front(part);
  for (const auto* point : variant.of(part)) {
    const auto& p = *point;
    const bool best = std::find(front.begin(), front.end(), point) != front.end();
    const auto marked = [&](const std::string& text) { return best ? bold(text) : Text(text); };
    std::vector<Text> row = {marked(p.fidelity), marked(p.settings), duration_text(p.cost.wall),
                             duration_text(p.cost.processor), fmt::format("{:.0f} MB", p.cost.peak_memory_MB)};
    std::pair<std::string, std::string> error;
    if (!p.failure.empty())
      error = {"failed", p.failure};
    else if (p.finest)
      error = {"finest", ""};
    else if (const auto* worst = p.worst())
      error = {percent(p.error()), variant.title(worst->key)};
    row.insert(row.end(), {error.first, error.second});
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Error of every figure, one column each.
PageTable errors_table(const VariantTrade& variant, TradePart part) {
  PageTable table{.head = {"setting"}, .style = PageTable::Style::numbers};
  for (const auto& f : variant.figures) table.head.emplace_back(f.title);
  for (const auto* p : variant.of(part)) {
    if (!p->failure.empty() || p->finest) continue;
    std::vector<Text> row = {setting_text(*p)};
    for (const auto& f : variant.figures) {
      const auto* v = p->find(f.key);
      Text cell = v && std::isfinite(v->error) ? percent(v->error) : "–";
      if (v && std::isfinite(v->error_estimate)) cell += " " + muted("(" + percent(v->error_estimate) + ")");
      row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Blocks part_section(const VariantTrade& variant, TradePart part) {
  const auto* finest = finest_of(variant, part);
  if (!finest) return {};
  const Blocks title = heading(part_title(part));
  if (!finest->failure.empty())
    return title + paragraph("The finest setting failed, so no errors are known: " + finest->failure);
  List cheapest;
  for (const auto& text : cheapest_texts(variant, part)) cheapest.items.emplace_back(text);
  return title +
         paragraph(fmt::format("Compared with: {}; {}, {:.0f} MB.", setting_text(*finest),
                               duration_text(finest->cost.wall), finest->cost.peak_memory_MB)) +
         cheapest +
         Pictures{{trade_plot(variant, part), fronts_plot(variant, part)},
                  {},
                  "Largest error over all results against wall time. The line joins the settings that no other setting "
                  "beats in both. Settings that leave parts of the model out have their own mark."} +
         paragraph("The cheapest setting for one result alone:") + cheapest_table(variant, part) +
         paragraph("All settings (bold: on the front of the largest error):") + points_table(variant, part) +
         estimates_text(variant, part) +
         details("Error of every result (in brackets: the estimate of the program)", errors_table(variant, part));
}

}  // namespace

Plot trade_plot(const VariantTrade& variant, TradePart part) {
  Plot plot = errors_plot(part_of(variant, part), "largest error", 400);
  Series front{.label = "front", .colour = 6};
  for (const auto* p : variant.front(part)) {
    front.x.push_back(p->cost.wall);
    front.y.push_back(p->error());
  }
  plot.series.push_back(std::move(front));
  for (const auto* p : variant.of(part)) {
    if (p->finest || !(p->error() > 0)) continue;
    auto same =
        std::find_if(plot.series.begin(), plot.series.end(), [&](const Series& s) { return s.label == p->fidelity; });
    if (same == plot.series.end())
      same = plot.series.insert(
          same, {.label = p->fidelity, .colour = plot.series.size() - 1, .style = Series::Style::dots, .size = 7});
    same->x.push_back(p->cost.wall);
    same->y.push_back(p->error());
  }
  return plot;
}

std::string trade_csv(const TradeOff& trade) {
  std::string text =
      fmt::format("# annulus_version: {}\n# scene: {}\n", version(), csv_remark(trade.scene.file.filename().string()));
  text += "variant,part,model,settings,finest,result,value,error,error_estimate,wall_s,processor_s,peak_MB,failure\n";
  for (const auto& variant : trade.variants) {
    for (const auto& p : variant.points) {
      const std::string head = fmt::format("{},{},{},{},{:d},", csv_cell(variant.name), part_name(p.part),
                                           csv_cell(p.fidelity), csv_cell(p.settings), p.finest);
      const std::string cost = fmt::format("{:.6g},{:.6g},{:.6g},{}\n", p.cost.wall, p.cost.processor,
                                           p.cost.peak_memory_MB, csv_cell(p.failure));
      if (p.values.empty()) text.append(head).append(",,,,").append(cost);
      for (const auto& v : p.values)
        text += fmt::format("{}{},{},{},{},{}", head, v.key, csv_cell(v.value), csv_cell(v.error),
                            csv_cell(v.error_estimate), cost);
    }
  }
  return text;
}

std::string trade_text(const TradeOff& trade) {
  std::string text;
  for (const auto& variant : trade.variants) {
    for (const auto part : both_parts) {
      if (!finest_of(variant, part)) continue;
      text += fmt::format("{}{}, {}\n", text.empty() ? "" : "\n", variant.name, part_title(part));
      for (const auto* p : variant.front(part))
        text += fmt::format("  {:>9}  {:>6.0f} MB  error {:>8}  {}\n", duration_text(p->cost.wall),
                            p->cost.peak_memory_MB, percent(p->error()), setting_text(*p));
      for (const auto& line : cheapest_texts(variant, part)) text += "  " + line + "\n";
    }
  }
  return text;
}

Page trade_page(const TradeOff& trade) {
  Page page{.title = "Error against cost: " + trade.scene.title,
            .sub = phrase("annulus {} · scene {} · {} for all settings, one after the other", version(),
                          code(trade.scene.file.filename().string()), duration_text(trade.total_seconds))};
  Blocks verdict;
  for (const auto& variant : trade.variants) {
    page.sections.push_back({file_name(variant.name), variant.name,
                             part_section(variant, TradePart::mesh) + part_section(variant, TradePart::dynamics)});
    for (const auto part : both_parts) {
      const auto* finest = finest_of(variant, part);
      if (finest && !finest->values.empty())
        verdict += paragraph(bold(part_of(variant, part)) + ". " + cheapest_text(variant, part, 0.01));
    }
  }
  page.summary = verdict_box(verdict);
  return page;
}

std::string trade_html(const TradeOff& trade) { return page_html(trade_page(trade)); }

void write_tradeoff(const TradeOff& trade, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_file(folder / "tradeoff.csv", trade_csv(trade));
  write_file(folder / "tradeoff.html", trade_html(trade));
  for (const auto& variant : trade.variants) {
    for (const auto part : both_parts) {
      if (!variant.front(part).empty())
        write_file(folder / fmt::format("tradeoff_{}_{}.svg", file_name(variant.name), part_name(part)),
                   to_svg(trade_plot(variant, part)));
    }
  }
}

}  // namespace annulus::app
