#include "app/study/point_store.h"

#include <cmath>
#include <limits>
#include <optional>

#include "app/model/run_options.h"
#include "core/result_store.h"

namespace annulus::app {

namespace {

// JSON knows neither NaN (not known: null) nor infinity (an unbounded share: a text).
Json point_number(double x) {
  if (std::isnan(x)) return nullptr;
  return std::isfinite(x) ? Json(x) : Json(x > 0 ? "inf" : "-inf");
}
double point_number(const Json& json) {
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (json.is_string()) return (json == "-inf" ? -1 : 1) * std::numeric_limits<double>::infinity();
  return json.get<double>();
}

}  // namespace

Json point_json(const StudyPoint& point, const std::vector<FigureSpec>& figures) {
  Json json = {{"failure", point.failure}};
  if (!point.failure.empty()) return json;
  for (const auto& figure : figures) json["figures"][figure.key] = point_number(point.value(figure.key));
  json["poincare_N_m"] = Json::array();
  for (const auto& p : point.poincare)
    json["poincare_N_m"].push_back(Json::array({point_number(p.force), point_number(p.deflection)}));
  return json;
}

StudyPoint point_of(const Json& json, const std::vector<FigureSpec>& figures) {
  StudyPoint point{.failure = json.at("failure")};
  if (!point.failure.empty()) return point;
  point.figures = FigureRow(figures);
  for (const auto& figure : figures) point.figures.set(figure.key, point_number(json.at("figures").at(figure.key)));
  for (const auto& p : json.at("poincare_N_m"))
    point.poincare.push_back({point_number(p.at(0)), point_number(p.at(1))});
  return point;
}

StudyPoint PointStore::point(const std::vector<Override>& overrides, const std::string& where, std::size_t variant,
                             const std::string& folder) const {
  constexpr const char* points = "study_points";
  const auto changed = subject_.model(overrides, where, variant, folder);
  const auto id = changed->id();
  const auto& store = subject_.options().store;
  const auto cached = store ? store->find(points, id) : std::nullopt;
  count_reuse(subject_.options(), study_responses, cached ? 1 : 0, cached ? 0 : 1);
  if (cached) return point_of(Json::parse(*cached), figures_);
  auto found = evaluate(*changed, Answer::all);
  if (store) store->keep(points, id, point_json(found, figures_).dump());
  return found;
}

}  // namespace annulus::app
