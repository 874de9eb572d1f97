#include "app/summary_studies.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace annulus::app {

namespace {

using StudyJson = nlohmann::ordered_json;

StudyJson finite_or_null(double x) { return std::isfinite(x) ? StudyJson(x) : StudyJson(nullptr); }

StudyJson interval_json(const dynamics::Interval& i) {
  return {{"value", finite_or_null(i.value)}, {"low", finite_or_null(i.low)}, {"high", finite_or_null(i.high)}};
}

StudyJson statistics_json(const FigureStatistics& s) {
  return {{"mean", interval_json(s.mean)},
          {"standard_deviation", finite_or_null(s.deviation)},
          {"quantile_05", interval_json(s.q05)},
          {"median", interval_json(s.median)},
          {"quantile_95", interval_json(s.q95)}};
}

StudyJson point_json(const StudyPoint& point) {
  if (!point.failure.empty()) return {{"failure", point.failure}};
  StudyJson json;
  const auto columns = figure_columns(false);
  const auto row = figure_row(point, false);
  for (std::size_t i = 0; i < columns.size(); ++i) json[columns[i]] = finite_or_null(row[i]);
  return json;
}

}  // namespace

std::string ring_studies_json(const RunResult& result, std::size_t index) {
  StudyJson ring = StudyJson::object();
  const auto& studies = result.studies;
  if (studies.monte_carlo) {
    const auto& samples = studies.monte_carlo->rings.at(index);
    StudyJson json = {{"samples", studies.monte_carlo->samples},
                      {"failed", samples.failed},
                      {"not_steady", samples.not_steady},
                      {"seed", studies.monte_carlo->seed},
                      {"confidence", dynamics::usual_confidence}};
    for (const auto& s : samples.statistics) json[s.figure] = statistics_json(s);
    ring["monte_carlo"] = std::move(json);
  }
  for (std::size_t n = 0; n < studies.sweeps.size(); ++n) {
    const auto& sweep = studies.sweeps[n];
    StudyJson json = {{"input", sweep.sweep.input}, {"unit", sweep.unit}, {"file", fmt::format("sweep_{}.csv", n + 1)}};
    int failed = 0;
    for (const auto& point : sweep.rings.at(index)) failed += point.failure.empty() ? 0 : 1;
    json["failed"] = failed;
    json["values"] = sweep.values;
    for (const auto* figure : {ordering_figure, "sun_planet_dynamic_factor", "ring_planet_dynamic_factor"}) {
      json[figure] = StudyJson::array();
      for (const auto& point : sweep.rings[index]) {
        const auto all = point_json(point);
        json[figure].push_back(all.value(figure, StudyJson(nullptr)));
      }
    }
    ring["sweeps"].push_back(std::move(json));
  }
  return ring.dump();
}

std::string studies_json(const RunResult& result) {
  StudyJson json = StudyJson::object();
  const auto& studies = result.studies;
  if (studies.monte_carlo) {
    auto& orders = json["monte_carlo"]["orders"] = StudyJson::array();
    for (const auto& o : studies.monte_carlo->orders)
      orders.push_back({{"figure", o.figure},
                        {"ring", result.rings[o.a].name},
                        {"above", result.rings[o.b].name},
                        {"share", interval_json(o.share)},
                        {"mean_difference", interval_json(o.difference)},
                        {"equal", o.equal},
                        {"samples", o.samples}});
  }
  if (!studies.sensitivity) return json.dump();
  const auto& sensitivity = *studies.sensitivity;
  auto& rows = json["sensitivity"] = {{"factor", sensitivity.factor}, {"inputs", StudyJson::array()}};
  for (const auto& row : sensitivity.rows) {
    StudyJson item = {{"input", row.input}, {"unit", row.unit}, {"order_of_rings_stays", row.order_stays}};
    for (std::size_t i = 0; i < result.rings.size(); ++i)
      item["rings"][result.rings[i].name] = {{"value", finite_or_null(row.values[i])},
                                             {"divided", point_json(row.divided[i])},
                                             {"nominal", point_json(sensitivity.nominal[i])},
                                             {"multiplied", point_json(row.multiplied[i])}};
    rows["inputs"].push_back(std::move(item));
  }
  return json.dump();
}

}  // namespace annulus::app
