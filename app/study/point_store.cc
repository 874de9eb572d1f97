#include "app/study/point_store.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include "app/content_id.h"
#include "app/model/run_options.h"
#include "core/files.h"
#include "core/json.h"

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

std::string point_text(const StudyPoint& point, const std::vector<FigureSpec>& figures, const std::string& id) {
  Json json = {{"inputs_id", id}, {"failure", point.failure}};
  if (point.failure.empty()) {
    for (const auto& figure : figures) json["figures"][figure.key] = point_number(point.value(figure.key));
    json["poincare_N_m"] = Json::array();
    for (const auto& p : point.poincare)
      json["poincare_N_m"].push_back(Json::array({point_number(p.force), point_number(p.deflection)}));
  }
  return json.dump() + "\n";
}

std::optional<StudyPoint> read_point(const std::filesystem::path& file, const std::vector<FigureSpec>& figures,
                                     const std::string& id) {
  std::ifstream in(file);
  if (!in) return std::nullopt;
  try {
    const auto json = Json::parse(in);
    if (json.at("inputs_id") != id) return std::nullopt;
    StudyPoint point{.failure = json.at("failure")};
    if (!point.failure.empty()) return point;
    point.figures = FigureRow(figures);
    for (const auto& figure : figures) point.figures.set(figure.key, point_number(json.at("figures").at(figure.key)));
    for (const auto& p : json.at("poincare_N_m"))
      point.poincare.push_back({point_number(p.at(0)), point_number(p.at(1))});
    return point;
  } catch (const std::exception&) {
    return std::nullopt;  // damaged: found again and overwritten
  }
}

StudyPoint PointStore::point(const std::vector<Override>& overrides, const std::string& where, std::size_t variant,
                             const std::string& folder) const {
  const auto changed = subject_.model(overrides, where, variant, folder, true);
  const auto points = subject_.folder(variant) / "points";
  const auto file = points / (changed.id + ".json");
  auto kept = read_point(file, figures_, changed.id);
  count_reuse(subject_.options(), study_responses, kept ? 1 : 0, kept ? 0 : 1);
  if (kept) return std::move(*kept);
  auto found = evaluate(changed, false);
  std::filesystem::create_directories(points);
  write_file(file, point_text(found, figures_, changed.id));
  return found;
}

}  // namespace annulus::app
