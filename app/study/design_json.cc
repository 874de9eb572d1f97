#include "app/study/design_json.h"

#include "app/study/point_store.h"

namespace annulus::app {

namespace {

Json row_json(const FigureRow& row, const std::vector<FigureSpec>& figures) {
  if (row.empty()) return nullptr;
  StudyPoint point;
  point.figures = row;
  return point_json(point, figures);
}

FigureRow row_of(const Json& json, const std::vector<FigureSpec>& figures) {
  return json.is_null() ? FigureRow{} : point_of(json, figures).figures;
}

}  // namespace

Json design_json(const Design& design, const std::vector<FigureSpec>& figures) {
  Json json = {{"point", point_json(design.point, figures)}, {"starts", nullptr}};
  if (const auto& s = design.starts)
    json["starts"] = {{"starts", s->starts},
                      {"motions", s->motions},
                      {"not_steady", s->not_steady},
                      {"low", row_json(s->low, figures)},
                      {"high", row_json(s->high, figures)}};
  return json;
}

Design design_of(const Json& json, const std::vector<double>& x, const std::vector<FigureSpec>& figures) {
  Design design{.x = x, .objective = 0, .point = point_of(json.at("point"), figures), .starts = std::nullopt};
  if (const auto& s = json.at("starts"); !s.is_null())
    design.starts = StartSpread{.starts = s.at("starts"),
                                .motions = s.at("motions"),
                                .low = row_of(s.at("low"), figures),
                                .high = row_of(s.at("high"), figures),
                                .not_steady = s.at("not_steady")};
  return design;
}

}  // namespace annulus::app
