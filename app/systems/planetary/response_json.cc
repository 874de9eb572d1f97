#include "app/systems/planetary/response_json.h"

#include <cmath>
#include <limits>

#include "app/results/content_id.h"
#include "core/json.h"

namespace annulus::app {

namespace {

Json to_json_value(const Figure& f, const ErrorParts& parts) {
  return {{"value", json_number(f.value)}, {"error", json_number(f.error)}, {"error_parts", to_json(parts)}};
}
Figure figure(const Json& json) { return {number_of(json.at("value")), number_of(json.at("error"))}; }

Json kind_json(const dynamics::MeshKindResult& kind, const MeshKindErrors& errors) {
  Json json;
  json["load_sharing"] = {{"instantaneous", to_json_value(kind.load_sharing.instantaneous, errors.instantaneous)},
                          {"averaged", to_json_value(kind.load_sharing.averaged, errors.averaged)},
                          {"quasi_static", to_json_value(kind.load_sharing.quasi_static, errors.quasi_static)}};
  for (std::size_t n = 0; n < kind.branches.size(); ++n) {
    const auto& b = kind.branches[n];
    json["branches"].push_back(
        {{"dynamic_factor_max", to_json_value(b.dynamic_factor_max, errors.dynamic_factor_max[n])},
         {"dynamic_factor_min", json_number(b.dynamic_factor_min)},
         {"mean_force_N", json_number(b.mean_force)},
         {"contact_loss", json_number(b.contact_loss)}});
  }
  return json;
}

dynamics::MeshKindResult kind_result(const Json& json) {
  dynamics::MeshKindResult kind;
  const auto& sharing = json.at("load_sharing");
  kind.load_sharing = {figure(sharing.at("instantaneous")), figure(sharing.at("averaged")),
                       figure(sharing.at("quasi_static"))};
  for (const auto& b : json.at("branches")) {
    kind.branches.push_back({figure(b.at("dynamic_factor_max")), number_of(b.at("dynamic_factor_min")),
                             number_of(b.at("mean_force_N")), number_of(b.at("contact_loss"))});
  }
  return kind;
}

ErrorParts errors_of(const Json& figure) { return error_parts_of(figure.at("error_parts")); }

MeshKindErrors kind_errors(const Json& json) {
  const auto& sharing = json.at("load_sharing");
  MeshKindErrors errors{errors_of(sharing.at("instantaneous")),
                        errors_of(sharing.at("averaged")),
                        errors_of(sharing.at("quasi_static")),
                        {}};
  for (const auto& b : json.at("branches")) errors.dynamic_factor_max.push_back(errors_of(b.at("dynamic_factor_max")));
  return errors;
}

Json modes_json(const StageModes& modes) {
  Json json = {{"groups", modes.groups}, {"bodies", modes.bodies}, {"list", Json::array()}};
  for (const auto& m : modes.list) {
    json["list"].push_back({{"frequency_Hz", m.frequency},
                            {"frequency_error_Hz", m.frequency_error},
                            {"error_parts_Hz", to_json(m.error_parts)},
                            {"kind", m.kind},
                            {"damped_frequency_Hz", m.damped_frequency},
                            {"damping_ratio", m.damping_ratio},
                            {"strain_energy", m.strain},
                            {"kinetic_energy", m.kinetic}});
  }
  return json;
}

StageModes modes_of(const Json& json) {
  StageModes modes;
  modes.groups = json.at("groups").get<std::vector<std::string>>();
  modes.bodies = json.at("bodies").get<std::vector<std::string>>();
  for (const auto& m : json.at("list")) {
    modes.list.push_back({number_of(m.at("frequency_Hz")), number_of(m.at("frequency_error_Hz")),
                          error_parts_of(m.at("error_parts_Hz")), m.at("kind"), number_of(m.at("damped_frequency_Hz")),
                          number_of(m.at("damping_ratio")), m.at("strain_energy").get<std::vector<double>>(),
                          m.at("kinetic_energy").get<std::vector<double>>()});
  }
  return modes;
}

Json motion_json(const StageMotion& m) {
  return {{"pin_force_max_N", m.pin_force_max},
          {"pin_force_mean_tangential_N", m.pin_force_mean_tangential},
          {"sun_support_max_N", json_number(m.sun_support_max)},
          {"ring_support_max_N", json_number(m.ring_support_max)},
          {"carrier_support_max_N", json_number(m.carrier_support_max)},
          {"ring_torque_mean_N_m", json_number(m.ring_torque_mean)},
          {"sun_orbit_extent_m", json_number(m.sun_orbit_extent)},
          {"sun_orbit_largest_m", json_number(m.sun_orbit_largest)},
          {"section", m.section},
          {"section_period_cycles", m.section_period ? Json(*m.section_period) : Json(nullptr)},
          {"section_clusters", m.section_clusters}};
}

StageMotion motion_of(const Json& json) {
  StageMotion m;
  m.pin_force_max = json.at("pin_force_max_N").get<std::vector<double>>();
  m.pin_force_mean_tangential = json.at("pin_force_mean_tangential_N").get<std::vector<double>>();
  m.sun_support_max = number_of(json.at("sun_support_max_N"));
  m.ring_support_max = number_of(json.at("ring_support_max_N"));
  m.carrier_support_max = number_of(json.at("carrier_support_max_N"));
  m.ring_torque_mean = number_of(json.at("ring_torque_mean_N_m"));
  m.sun_orbit_extent = number_of(json.at("sun_orbit_extent_m"));
  m.sun_orbit_largest = number_of(json.at("sun_orbit_largest_m"));
  m.section = json.at("section");
  if (const auto& period = json.at("section_period_cycles"); !period.is_null()) m.section_period = period.get<int>();
  m.section_clusters = json.at("section_clusters");
  return m;
}

Json direct_json(const std::optional<dynamics::PeriodicSolution>& direct) {
  if (!direct) return nullptr;
  const bool piecewise = direct->method == dynamics::PeriodicMethod::piecewise;
  return {{"method", piecewise ? "piecewise" : "harmonic_balance"},
          {"converged", direct->converged},
          {"trouble", direct->trouble},
          {"newton_iterations", direct->newton_iterations},
          {"linear_iterations", direct->linear_iterations},
          {"residual", json_number(direct->residual)},
          {"sampling_difference", json_number(direct->sampling_difference)},
          {"largest_multiplier", json_number(direct->largest_multiplier)}};
}

std::optional<dynamics::PeriodicSolution> direct_of(const Json& json) {
  if (json.is_null()) return std::nullopt;
  dynamics::PeriodicSolution direct;
  direct.method = json.at("method") == "piecewise" ? dynamics::PeriodicMethod::piecewise
                                                   : dynamics::PeriodicMethod::harmonic_balance;
  direct.converged = json.at("converged");
  direct.trouble = json.at("trouble");
  direct.newton_iterations = json.at("newton_iterations");
  direct.linear_iterations = json.at("linear_iterations");
  direct.residual = number_of(json.at("residual"));
  direct.sampling_difference = number_of(json.at("sampling_difference"));
  if (!json.at("largest_multiplier").is_null()) direct.largest_multiplier = json.at("largest_multiplier").get<double>();
  return direct;
}

}  // namespace

std::string response_json(const StageResponse& response, const std::string& id) {
  const auto& f = response.figures;
  Json json = {{"annulus_version", version()},
               {"inputs_id", id},
               {"mesh_frequency_Hz", f.mesh_frequency},
               {"mean_mesh_force_N", f.mean_mesh_force},
               {"window_cycles", f.window_cycles},
               {"whole_error_period", f.whole_period},
               {"total_cycles", f.total_cycles},
               {"steady", f.steady},
               {"steady_difference", json_number(f.steady_difference)},
               {"confirmed", f.confirmed},
               {"direct", direct_json(f.periodic)},
               {"integrator_reason", f.integrator ? Json(f.integrator->reason) : Json(nullptr)},
               {"sun_planet", kind_json(f.sun_planet, response.errors.sun_planet)},
               {"ring_planet", kind_json(f.ring_planet, response.errors.ring_planet)},
               {"energy_balance_relative", json_number(f.energy.relative)},
               {"force_balance_relative", json_number(f.force_balance_relative)},
               {"steps", f.statistics.steps},
               {"contact_events", f.statistics.contact_events}};
  json["modes"] = modes_json(response.modes);
  json["motion"] = motion_json(response.motion);
  return json.dump(2) + "\n";
}

StageResponse parse_response_json(const std::string& text) {
  const auto json = Json::parse(text);
  StageResponse response;
  auto& f = response.figures;
  f.mesh_frequency = number_of(json.at("mesh_frequency_Hz"));
  f.mean_mesh_force = number_of(json.at("mean_mesh_force_N"));
  f.window_cycles = json.at("window_cycles");
  f.whole_period = json.at("whole_error_period");
  f.total_cycles = json.at("total_cycles");
  f.steady = json.at("steady");
  if (const auto& d = json.at("steady_difference"); !d.is_null()) f.steady_difference = d.get<double>();
  f.confirmed = json.at("confirmed");
  f.periodic = direct_of(json.at("direct"));
  if (const auto& reason = json.at("integrator_reason"); !reason.is_null()) f.integrator.emplace().reason = reason;
  f.sun_planet = kind_result(json.at("sun_planet"));
  f.ring_planet = kind_result(json.at("ring_planet"));
  response.errors = {kind_errors(json.at("sun_planet")), kind_errors(json.at("ring_planet"))};
  f.energy.relative = number_of(json.at("energy_balance_relative"));
  f.force_balance_relative = number_of(json.at("force_balance_relative"));
  f.statistics.steps = json.at("steps");
  f.statistics.contact_events = json.at("contact_events");
  response.modes = modes_of(json.at("modes"));
  response.motion = motion_of(json.at("motion"));
  return response;
}

}  // namespace annulus::app
