#include "app/point_store.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/content_id.h"

namespace annulus::app {

namespace {

using PointJson = nlohmann::ordered_json;

// JSON knows neither NaN (not known: null) nor infinity (an unbounded share: a text).
PointJson point_number(double x) {
  if (std::isnan(x)) return nullptr;
  return std::isfinite(x) ? PointJson(x) : PointJson(x > 0 ? "inf" : "-inf");
}
double point_number(const PointJson& json) {
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (json.is_string()) return (json == "-inf" ? -1 : 1) * std::numeric_limits<double>::infinity();
  return json.get<double>();
}

PointJson numbers(std::initializer_list<double> values) {
  PointJson list = PointJson::array();
  for (const double x : values) list.push_back(point_number(x));
  return list;
}

PointJson kind_figures(const dynamics::KindFigures& k) {
  return numbers({k.instantaneous, k.averaged, k.quasi_static, k.dynamic_factor, k.contact_loss});
}
dynamics::KindFigures kind_figures(const PointJson& j) {
  return {point_number(j.at(0)), point_number(j.at(1)), point_number(j.at(2)), point_number(j.at(3)),
          point_number(j.at(4))};
}
PointJson motion_json(const dynamics::MotionRange& m) { return numbers({m.rms, m.peak_to_peak}); }
dynamics::MotionRange motion(const PointJson& j) { return {point_number(j.at(0)), point_number(j.at(1))}; }

std::string point_text(const StudyPoint& point, const std::string& id) {
  const auto& f = point.figures;
  PointJson json = {{"inputs_id", id}, {"failure", point.failure}};
  if (point.failure.empty()) {
    json["sun_planet"] = kind_figures(f.sun_planet);
    json["ring_planet"] = kind_figures(f.ring_planet);
    json["steady"] = f.steady;
    json["window_cycles"] = f.window_cycles;
    json["sun"] = motion_json(f.sun);
    json["sun_mesh"] = motion_json(f.sun_mesh);
    json["ring_mesh"] = motion_json(f.ring_mesh);
    json["frequencies_Hz"] = f.frequencies;
    json["poincare_N_m"] = PointJson::array();
    for (const auto& p : f.poincare) json["poincare_N_m"].push_back(numbers({p.force, p.deflection}));
  }
  return json.dump() + "\n";
}

std::optional<StudyPoint> read_point(const std::filesystem::path& file, const std::string& id) {
  std::ifstream in(file);
  if (!in) return std::nullopt;
  try {
    const auto json = PointJson::parse(in);
    if (json.at("inputs_id") != id) return std::nullopt;
    StudyPoint point{.figures = {}, .failure = json.at("failure")};
    if (!point.failure.empty()) return point;
    auto& f = point.figures;
    f.sun_planet = kind_figures(json.at("sun_planet"));
    f.ring_planet = kind_figures(json.at("ring_planet"));
    f.steady = json.at("steady");
    f.window_cycles = json.at("window_cycles");
    f.sun = motion(json.at("sun"));
    f.sun_mesh = motion(json.at("sun_mesh"));
    f.ring_mesh = motion(json.at("ring_mesh"));
    f.frequencies = json.at("frequencies_Hz").get<std::vector<double>>();
    for (const auto& p : json.at("poincare_N_m")) f.poincare.push_back({point_number(p.at(0)), point_number(p.at(1))});
    return point;
  } catch (const std::exception&) {
    return std::nullopt;  // damaged: found again and overwritten
  }
}

std::string one_line(std::string text) {
  for (auto& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

}  // namespace

StudyPoint evaluate(const ChangedStage& changed, bool motion) {
  try {
    return {dynamics::evaluate_point(changed.stage, {.simulation = changed.simulation, .motion = motion}), ""};
  } catch (const Error& error) {
    return {{}, one_line(error.what())};
  }
}

StudyPoint PointStore::point(const std::vector<Override>& overrides, const std::string& where, std::size_t ring,
                             const std::string& folder) const {
  const auto changed = stages_.stage(overrides, where, ring, folder, true);
  const auto points = stages_.options().out / stages_.nominal().rings.at(ring).name / "dynamics" / "points";
  const std::string id = ContentId().add("response", changed.id).add("method", dynamics::point_method()).id();
  const auto file = points / (id + ".json");
  if (auto kept = read_point(file, id)) return std::move(*kept);
  const auto found = evaluate(changed, true);
  std::filesystem::create_directories(points);
  write_file(file, point_text(found, id));
  return found;
}

}  // namespace annulus::app
