#include "app/response_json.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/content_id.h"

namespace annulus::app {

namespace {

using ResponseJson = nlohmann::ordered_json;

// JSON has no NaN: not known is null.
ResponseJson number(double x) { return std::isfinite(x) ? ResponseJson(x) : ResponseJson(nullptr); }
double number(const ResponseJson& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

ResponseJson to_json_value(const dynamics::Figure& f) {
  return {{"value", number(f.value)}, {"error", number(f.error)}};
}
dynamics::Figure figure(const ResponseJson& json) { return {number(json.at("value")), number(json.at("error"))}; }

ResponseJson kind_json(const dynamics::MeshKindResult& kind) {
  ResponseJson json;
  json["load_sharing"] = {{"instantaneous", to_json_value(kind.load_sharing.instantaneous)},
                          {"averaged", to_json_value(kind.load_sharing.averaged)},
                          {"quasi_static", to_json_value(kind.load_sharing.quasi_static)}};
  for (const auto& b : kind.branches) {
    json["branches"].push_back({{"dynamic_factor_max", to_json_value(b.dynamic_factor_max)},
                                {"dynamic_factor_min", number(b.dynamic_factor_min)},
                                {"mean_force_N", number(b.mean_force)},
                                {"contact_loss", number(b.contact_loss)}});
  }
  return json;
}

dynamics::MeshKindResult kind_result(const ResponseJson& json) {
  dynamics::MeshKindResult kind;
  const auto& sharing = json.at("load_sharing");
  kind.load_sharing = {figure(sharing.at("instantaneous")), figure(sharing.at("averaged")),
                       figure(sharing.at("quasi_static"))};
  for (const auto& b : json.at("branches")) {
    kind.branches.push_back({figure(b.at("dynamic_factor_max")), number(b.at("dynamic_factor_min")),
                             number(b.at("mean_force_N")), number(b.at("contact_loss"))});
  }
  return kind;
}

}  // namespace

std::string response_json(const StageResponse& response, const std::string& id) {
  const auto& f = response.figures;
  ResponseJson json = {
      {"annulus_version", version()},
      {"inputs_id", id},
      {"mesh_frequency_Hz", f.mesh_frequency},
      {"mean_mesh_force_N", f.mean_mesh_force},
      {"window_cycles", f.window_cycles},
      {"whole_error_period", f.whole_error_period},
      {"total_cycles", f.total_cycles},
      {"steady", f.steady},
      {"steady_difference", number(f.steady_difference.value_or(std::numeric_limits<double>::quiet_NaN()))},
      {"sun_planet", kind_json(f.sun_planet)},
      {"ring_planet", kind_json(f.ring_planet)},
      {"energy_balance_relative", number(f.energy.relative)},
      {"force_balance_relative", number(f.force_balance_relative)},
      {"steps", f.statistics.steps},
      {"contact_events", f.statistics.contact_events}};
  for (const auto& mode : response.modes)
    json["modes"].push_back({{"frequency_Hz", mode.frequency}, {"kind", mode.kind}});
  return json.dump(2) + "\n";
}

std::optional<StageResponse> parse_response_json(const std::filesystem::path& file, const std::string& id) {
  std::ifstream in(file);
  const auto json = ResponseJson::parse(in);
  if (json.at("inputs_id") != id) return std::nullopt;
  StageResponse response;
  auto& f = response.figures;
  f.mesh_frequency = number(json.at("mesh_frequency_Hz"));
  f.mean_mesh_force = number(json.at("mean_mesh_force_N"));
  f.window_cycles = json.at("window_cycles");
  f.whole_error_period = json.at("whole_error_period");
  f.total_cycles = json.at("total_cycles");
  f.steady = json.at("steady");
  if (const auto& d = json.at("steady_difference"); !d.is_null()) f.steady_difference = number(d);
  f.sun_planet = kind_result(json.at("sun_planet"));
  f.ring_planet = kind_result(json.at("ring_planet"));
  f.energy.relative = number(json.at("energy_balance_relative"));
  f.force_balance_relative = number(json.at("force_balance_relative"));
  f.statistics.steps = json.at("steps");
  f.statistics.contact_events = json.at("contact_events");
  for (const auto& mode : json.at("modes"))
    response.modes.push_back({number(mode.at("frequency_Hz")), mode.at("kind")});
  return response;
}

}  // namespace annulus::app
