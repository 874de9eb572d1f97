#include "app/systems/planetary/response_json.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/content_id.h"
#include "app/model/error_parts_json.h"

namespace annulus::app {

namespace {

using ResponseJson = nlohmann::ordered_json;

// JSON has no NaN: not known is null.
ResponseJson number(double x) { return std::isfinite(x) ? ResponseJson(x) : ResponseJson(nullptr); }
double number(const ResponseJson& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

ResponseJson to_json_value(const Figure& f, const ErrorParts& parts) {
  return {{"value", number(f.value)},
          {"error", number(f.error)},
          {"error_parts", ResponseJson::parse(error_parts_json(parts))}};
}
Figure figure(const ResponseJson& json) { return {number(json.at("value")), number(json.at("error"))}; }

ResponseJson kind_json(const dynamics::MeshKindResult& kind, const MeshKindErrors& errors) {
  ResponseJson json;
  json["load_sharing"] = {{"instantaneous", to_json_value(kind.load_sharing.instantaneous, errors.instantaneous)},
                          {"averaged", to_json_value(kind.load_sharing.averaged, errors.averaged)},
                          {"quasi_static", to_json_value(kind.load_sharing.quasi_static, errors.quasi_static)}};
  for (std::size_t n = 0; n < kind.branches.size(); ++n) {
    const auto& b = kind.branches[n];
    json["branches"].push_back(
        {{"dynamic_factor_max", to_json_value(b.dynamic_factor_max, errors.dynamic_factor_max[n])},
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

ErrorParts errors_of(const ResponseJson& figure) { return parse_error_parts(figure.at("error_parts").dump()); }

MeshKindErrors kind_errors(const ResponseJson& json) {
  const auto& sharing = json.at("load_sharing");
  MeshKindErrors errors{errors_of(sharing.at("instantaneous")),
                        errors_of(sharing.at("averaged")),
                        errors_of(sharing.at("quasi_static")),
                        {}};
  for (const auto& b : json.at("branches")) errors.dynamic_factor_max.push_back(errors_of(b.at("dynamic_factor_max")));
  return errors;
}

ResponseJson modes_json(const StageModes& modes) {
  ResponseJson json = {{"groups", modes.groups}, {"bodies", modes.bodies}, {"list", ResponseJson::array()}};
  for (const auto& m : modes.list) {
    json["list"].push_back({{"frequency_Hz", m.frequency},
                            {"frequency_error_Hz", m.frequency_error},
                            {"error_parts_Hz", ResponseJson::parse(error_parts_json(m.error_parts))},
                            {"kind", m.kind},
                            {"damped_frequency_Hz", m.damped_frequency},
                            {"damping_ratio", m.damping_ratio},
                            {"strain_energy", m.strain},
                            {"kinetic_energy", m.kinetic}});
  }
  return json;
}

StageModes modes_of(const ResponseJson& json) {
  StageModes modes;
  modes.groups = json.at("groups").get<std::vector<std::string>>();
  modes.bodies = json.at("bodies").get<std::vector<std::string>>();
  for (const auto& m : json.at("list")) {
    modes.list.push_back({number(m.at("frequency_Hz")), number(m.at("frequency_error_Hz")),
                          parse_error_parts(m.at("error_parts_Hz").dump()), m.at("kind"),
                          number(m.at("damped_frequency_Hz")), number(m.at("damping_ratio")),
                          m.at("strain_energy").get<std::vector<double>>(),
                          m.at("kinetic_energy").get<std::vector<double>>()});
  }
  return modes;
}

ResponseJson motion_json(const StageMotion& m) {
  return {{"pin_force_max_N", m.pin_force_max},
          {"pin_force_mean_tangential_N", m.pin_force_mean_tangential},
          {"sun_support_max_N", number(m.sun_support_max)},
          {"ring_support_max_N", number(m.ring_support_max)},
          {"carrier_support_max_N", number(m.carrier_support_max)},
          {"ring_torque_mean_N_m", number(m.ring_torque_mean)},
          {"sun_orbit_extent_m", number(m.sun_orbit_extent)},
          {"sun_orbit_largest_m", number(m.sun_orbit_largest)},
          {"section", m.section},
          {"section_period_cycles", m.section_period ? ResponseJson(*m.section_period) : ResponseJson(nullptr)},
          {"section_clusters", m.section_clusters}};
}

StageMotion motion_of(const ResponseJson& json) {
  StageMotion m;
  m.pin_force_max = json.at("pin_force_max_N").get<std::vector<double>>();
  m.pin_force_mean_tangential = json.at("pin_force_mean_tangential_N").get<std::vector<double>>();
  m.sun_support_max = number(json.at("sun_support_max_N"));
  m.ring_support_max = number(json.at("ring_support_max_N"));
  m.carrier_support_max = number(json.at("carrier_support_max_N"));
  m.ring_torque_mean = number(json.at("ring_torque_mean_N_m"));
  m.sun_orbit_extent = number(json.at("sun_orbit_extent_m"));
  m.sun_orbit_largest = number(json.at("sun_orbit_largest_m"));
  m.section = json.at("section");
  if (const auto& period = json.at("section_period_cycles"); !period.is_null()) m.section_period = period.get<int>();
  m.section_clusters = json.at("section_clusters");
  return m;
}

ResponseJson direct_json(const std::optional<dynamics::PeriodicSolution>& direct) {
  if (!direct) return nullptr;
  return {{"converged", direct->converged},
          {"trouble", direct->trouble},
          {"newton_iterations", direct->newton_iterations},
          {"linear_iterations", direct->linear_iterations},
          {"residual", number(direct->residual)},
          {"sampling_difference", number(direct->sampling_difference)}};
}

std::optional<dynamics::PeriodicSolution> direct_of(const ResponseJson& json) {
  if (json.is_null()) return std::nullopt;
  dynamics::PeriodicSolution direct;
  direct.converged = json.at("converged");
  direct.trouble = json.at("trouble");
  direct.newton_iterations = json.at("newton_iterations");
  direct.linear_iterations = json.at("linear_iterations");
  direct.residual = number(json.at("residual"));
  direct.sampling_difference = number(json.at("sampling_difference"));
  return direct;
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
      {"whole_error_period", f.whole_period},
      {"total_cycles", f.total_cycles},
      {"steady", f.steady},
      {"steady_difference", number(f.steady_difference.value_or(std::numeric_limits<double>::quiet_NaN()))},
      {"confirmed", f.confirmed},
      {"direct", direct_json(f.periodic)},
      {"integrator_reason", f.integrator ? ResponseJson(f.integrator->reason) : ResponseJson(nullptr)},
      {"sun_planet", kind_json(f.sun_planet, response.errors.sun_planet)},
      {"ring_planet", kind_json(f.ring_planet, response.errors.ring_planet)},
      {"energy_balance_relative", number(f.energy.relative)},
      {"force_balance_relative", number(f.force_balance_relative)},
      {"steps", f.statistics.steps},
      {"contact_events", f.statistics.contact_events}};
  json["modes"] = modes_json(response.modes);
  json["motion"] = motion_json(response.motion);
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
  f.whole_period = json.at("whole_error_period");
  f.total_cycles = json.at("total_cycles");
  f.steady = json.at("steady");
  if (const auto& d = json.at("steady_difference"); !d.is_null()) f.steady_difference = number(d);
  f.confirmed = json.at("confirmed");
  f.periodic = direct_of(json.at("direct"));
  if (const auto& reason = json.at("integrator_reason"); !reason.is_null()) f.integrator.emplace().reason = reason;
  f.sun_planet = kind_result(json.at("sun_planet"));
  f.ring_planet = kind_result(json.at("ring_planet"));
  response.errors = {kind_errors(json.at("sun_planet")), kind_errors(json.at("ring_planet"))};
  f.energy.relative = number(json.at("energy_balance_relative"));
  f.force_balance_relative = number(json.at("force_balance_relative"));
  f.statistics.steps = json.at("steps");
  f.statistics.contact_events = json.at("contact_events");
  response.modes = modes_of(json.at("modes"));
  response.motion = motion_of(json.at("motion"));
  return response;
}

}  // namespace annulus::app
