#include "app/study/summary_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace annulus::app {

std::string order_column(const std::string& variant_word) { return fmt::format("order_of_{}s_stays", variant_word); }

Json interval_json(const dynamics::Interval& i) {
  return {{"value", json_number(i.value)}, {"low", json_number(i.low)}, {"high", json_number(i.high)}};
}

namespace {

Json statistics_json(const FigureStatistics& s) {
  return {{"mean", interval_json(s.mean)},
          {"standard_deviation", json_number(s.deviation)},
          {"quantile_05", interval_json(s.q05)},
          {"median", interval_json(s.median)},
          {"quantile_95", interval_json(s.q95)}};
}

Json point_json(const StudyResults& studies, const StudyPoint& point) {
  if (!point.failure.empty()) return {{"failure", point.failure}};
  Json json;
  for (const auto& figure : studies.figures)
    if (figure.effort != FigureEffort::motion) json[figure.key] = json_number(point.value(figure.key));
  return json;
}

/// A sweep or grid: after its inputs the file, how many points failed, the axes, and the results that are plotted.
Json points_json(Json json, const std::string& file,
                 const std::vector<std::pair<const char*, std::vector<double>>>& axes, const StudyResults& studies,
                 const std::vector<StudyPoint>& points) {
  json["file"] = file;
  json["failed"] = std::count_if(points.begin(), points.end(), [](const auto& p) { return !p.failure.empty(); });
  for (const auto& [name, values] : axes) json[name] = values;
  for (const auto& figure : studies.figures) {
    if (!figure.plotted) continue;
    auto& list = json[figure.key] = Json::array();
    for (const auto& point : points) list.push_back(json_number(point.value(figure.key)));
  }
  return json;
}

/// Where branches change their stability, and why some end within the range.
Json branches_json(const SweepBranches& found) {
  if (!found.failure.empty()) return {{"failure", found.failure}};
  auto list = Json::array();
  for (const auto& branch : found.branches) {
    auto events = Json::array();
    for (const auto& e : branch.events)
      events.push_back({{"kind", to_string(e.kind)}, {"value", e.input}, {"error", json_number(e.error)}});
    list.push_back({{"points", branch.points.size()},
                    {"stable_throughout",
                     std::all_of(branch.points.begin(), branch.points.end(), [](const auto& p) { return p.stable; })},
                    {"events", std::move(events)},
                    {"end", branch.end}});
  }
  return list;
}

Json load_spectrum_json(const StudyResults& studies, std::size_t variant) {
  const auto& spectrum = *studies.load_spectrum;
  Json json = {{"file", "load_spectrum.csv"}, {"duration_h", spectrum.duration() / units::hour}};
  for (std::size_t n = 0; n < spectrum.classes.size(); ++n) {
    const auto& load = spectrum.classes[n];
    Json one = {{"name", load.name}, {"duration_h", load.duration / units::hour}};
    for (std::size_t i = 0; i < spectrum.inputs.size(); ++i) one["inputs"][spectrum.inputs[i]] = load.values[i];
    one["results"] = point_json(studies, spectrum.variants.at(variant)[n]);
    json["classes"].push_back(std::move(one));
  }
  for (const auto& figure : studies.figures) {
    if (figure.effort == FigureEffort::motion) continue;
    const auto all = spectrum.overall(variant, figure.key);
    if (std::isnan(all.largest)) continue;
    json["over_all_classes"][figure.key] = {{"largest", json_number(all.largest)},
                                            {"in_class", spectrum.classes[all.of_class].name},
                                            {"mean_over_time", json_number(all.mean)}};
  }
  return json;
}

Json transient_json(const TransientResult& course, std::size_t number, std::size_t variant) {
  const auto& found = course.variants.at(variant);
  Json json = {{"name", course.input.name}, {"file", fmt::format("transient_{}.csv", number)}};
  if (!found.failure.empty()) {
    json["failure"] = found.failure;
    return json;
  }
  const auto& r = found.response;
  const auto peak = r.peak();
  for (const auto& spec : dynamics::transient_figures())
    if (const auto* entry = found.figures.find(spec.key)) json["results"][spec.key] = to_json(entry->figure);
  json["at"] = {{"mesh", r.meshes[static_cast<std::size_t>(peak.mesh)]},
                {"time_s", json_number(peak.time)},
                {"speed_factor", json_number(peak.speed)}};
  for (int row = 0; row < static_cast<int>(r.meshes.size()); ++row)
    json[row < r.gears ? "contact_loss" : "shaft_torque"][r.meshes[static_cast<std::size_t>(row)]] =
        to_json(found.figures.figure(dynamics::course_element_key(row)));
  json["settled_before"] = r.settled ? Json(*r.settled) : Json();
  json["warnings"] = course.warnings(variant);
  return json;
}

}  // namespace

Json variant_studies_json(const StudyResults& studies, std::size_t variant) {
  Json all = Json::object();
  if (studies.monte_carlo) {
    const auto& samples = studies.monte_carlo->variants.at(variant);
    Json json = {{"samples", studies.monte_carlo->samples},
                 {"by_default", studies.monte_carlo->by_default},
                 {"failed", samples.failed},
                 {"not_steady", samples.not_steady},
                 {"seed", studies.monte_carlo->seed},
                 {"confidence", dynamics::usual_confidence}};
    for (const auto& s : samples.statistics) json[s.figure] = statistics_json(s);
    all["monte_carlo"] = std::move(json);
  }
  for (std::size_t n = 0; n < studies.sweeps.size(); ++n) {
    const auto& sweep = studies.sweeps[n];
    auto json = points_json({{"input", sweep.sweep.input}, {"unit", sweep.unit}}, fmt::format("sweep_{}.csv", n + 1),
                            {{"values", sweep.values}}, studies, sweep.variants.at(variant));
    if (!sweep.downwards.empty())
      json["down"] = points_json({{"input", sweep.sweep.input}}, fmt::format("sweep_{}_down.csv", n + 1),
                                 {{"values", sweep.values}}, studies, sweep.downwards.at(variant));
    if (!sweep.branches.empty()) json["branches"] = branches_json(sweep.branches.at(variant));
    all["sweeps"].push_back(std::move(json));
  }
  for (std::size_t n = 0; n < studies.grids.size(); ++n) {
    const auto& grid = studies.grids[n];
    all["grids"].push_back(points_json({{"x_input", grid.grid.x.input},
                                        {"x_unit", grid.x_unit},
                                        {"y_input", grid.grid.y.input},
                                        {"y_unit", grid.y_unit}},
                                       fmt::format("grid_{}.csv", n + 1), {{"x", grid.x}, {"y", grid.y}}, studies,
                                       grid.variants.at(variant)));
  }
  if (studies.load_spectrum) all["load_spectrum"] = load_spectrum_json(studies, variant);
  for (std::size_t n = 0; n < studies.transients.size(); ++n)
    all["transients"].push_back(transient_json(studies.transients[n], n + 1, variant));
  return all;
}

namespace {

Json design_json(const StudyResults& studies, const OptimiseResults& o, const Design& design) {
  Json json = {{"objective", json_number(design.objective)}};
  for (std::size_t i = 0; i < design.x.size(); ++i) json["inputs"][o.variables[i].input] = json_number(design.x[i]);
  json["figures"] = point_json(studies, design.point);
  if (design.starts)
    json["initial_conditions"] = {{"tried", design.starts->starts},
                                  {"motions", design.starts->motions},
                                  {"not_steady", design.starts->not_steady}};
  return json;
}

Json optimise_json(const StudyResults& studies) {
  const auto& o = *studies.optimise;
  const double sign = o.settings.goal == Goal::smallest ? 1 : -1;
  Json json = {{"objective", o.settings.objective},
               {"flat", o.range.flat},
               {"least_meaning", json_number(o.range.least_meaning)},
               {"given", design_json(studies, o, o.given)},
               {"best", design_json(studies, o, o.best)}};
  if (!studies.variants[o.variant].empty()) json[studies.variant_word] = studies.variants[o.variant];
  for (std::size_t i = 0; i < o.runs.size(); ++i) {
    const auto& run = o.runs[i];
    json["searches"].push_back(
        {{"optimiser", run.optimiser},
         {"repeat", run.repeat},
         {"best", json_number(sign * run.search.value)},
         {"evaluations", run.search.evaluations.size()},
         {"failed", run.search.failed},
         {"evaluations_to_best", o.evaluations_to_best[i] ? Json(*o.evaluations_to_best[i]) : Json(nullptr)}});
  }
  return json;
}

}  // namespace

Json studies_json(const StudyResults& studies) {
  Json json = Json::object();
  if (studies.optimise) json["optimise"] = optimise_json(studies);
  if (studies.monte_carlo && studies.variants.size() > 1) {
    auto& orders = json["monte_carlo"]["orders"] = Json::array();
    for (const auto& o : studies.monte_carlo->orders)
      orders.push_back({{"result", o.figure},
                        {studies.variant_word, studies.variants[o.a]},
                        {"above", studies.variants[o.b]},
                        {"share", interval_json(o.share)},
                        {"mean_difference", interval_json(o.difference)},
                        {"equal", o.equal},
                        {"samples", o.samples}});
  }
  if (!studies.sensitivity) return json;
  const auto& sensitivity = *studies.sensitivity;
  auto& rows = json["sensitivity"] = {{"factor", sensitivity.factor}, {"inputs", Json::array()}};
  for (const auto& row : sensitivity.rows) {
    Json item = {{"input", row.input}, {"unit", row.unit}, {order_column(studies.variant_word), row.order_stays}};
    for (std::size_t i = 0; i < studies.variants.size(); ++i) {
      Json values = {{"value", json_number(row.values[i])},
                     {"divided", point_json(studies, row.divided[i])},
                     {"nominal", point_json(studies, sensitivity.nominal[i])},
                     {"multiplied", point_json(studies, row.multiplied[i])}};
      if (studies.variants[i].empty())
        item.update(values);
      else
        item[studies.variant_word + "s"][studies.variants[i]] = std::move(values);
    }
    rows["inputs"].push_back(std::move(item));
  }
  return json;
}

}  // namespace annulus::app
