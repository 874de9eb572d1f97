#include "app/model/found_motions.h"
#include "app/systems/planetary/planetary_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "app/sections/report_parts.h"
#include "app/sections/shafts.h"
#include "app/study/summary_studies.h"
#include "app/systems/planetary/power_flow.h"
#include "app/systems/planetary/roller_loads.h"
#include "app/systems/planetary/strain_gauges.h"
#include "app/systems/shared/mesh_names.h"
#include "core/json.h"
#include "core/units.h"

namespace annulus::app {

namespace {

Json estimate_json(const Estimate& e) {
  return {{"value", json_number(e.value)},
          {"error_relative", json_number(e.error_relative)},
          {"error_parts_relative", to_json(e.parts)}};
}
Json figure_json(const Figure& f, const ErrorParts& e) {
  return {{"value", json_number(f.value)}, {"error", json_number(f.error)}, {"error_parts", to_json(e)}};
}

Json peak_json(const Peak& peak, double unit) {
  return {{"value", json_number(peak.value * unit)},
          {"mesh_phase", peak.at.mesh_phase},
          {"ring_tooth", peak.at.ring_tooth}};
}

Json mesh_json(const MeshResult& mesh) {
  Json json = {{"model", mesh.model.fidelity},
               {"contact_ratio", mesh.contact_ratio},
               {"nominal_load_N", mesh.table.loads()[mesh.nominal]},
               {"mean_stiffness_N_per_m", estimate_json(mesh.mean_stiffness())},
               {"lte_mean_m", estimate_json(mesh.lte_mean())},
               {"lte_peak_to_peak_m", estimate_json(mesh.lte_peak_to_peak())},
               {"reused", mesh.reused},
               {"inputs_id", mesh.model.id()}};
  for (const auto& [name, value] : mesh.facts) json[name] = json_number(value);
  if (const auto factor = mesh.peak("face_load_factor")) json["face_load_factor"] = peak_json(*factor, 1);
  for (const auto& column : mesh.positions.columns) {
    if (!column.ends_with("_MPa") || column == "max_pressure_MPa") continue;
    const std::string name = column.substr(0, column.size() - 4);
    if (const auto stress = mesh.peak(column)) json["max_stress_Pa"][name] = peak_json(*stress, 1e6);
  }
  return json;
}

Json sharing_json(const dynamics::LoadSharing& s, const MeshKindErrors& e) {
  return {{"instantaneous", figure_json(s.instantaneous, e.instantaneous)},
          {"averaged", figure_json(s.averaged, e.averaged)},
          {"quasi_static", figure_json(s.quasi_static, e.quasi_static)}};
}

void add_branches(Json& ring, const std::string& mesh, const dynamics::MeshKindResult& kind,
                  const MeshKindErrors& errors) {
  const auto factors = [&](const char* name, Figure dynamics::BranchResult::*factor,
                           const std::vector<ErrorParts>& parts_of) {
    auto value = Json::array(), error = value, parts = value;
    for (const auto& b : kind.branches) {
      value.push_back(json_number((b.*factor).value));
      error.push_back(json_number((b.*factor).error));
    }
    for (const auto& e : parts_of) parts.push_back(to_json(e));
    ring[name][mesh] = std::move(value);
    ring[fmt::format("{}_error", name)][mesh] = std::move(error);
    ring[fmt::format("{}_error_parts", name)][mesh] = std::move(parts);
  };
  factors("dynamic_factor", &dynamics::BranchResult::dynamic_factor, errors.dynamic_factor);
  factors("peak_factor", &dynamics::BranchResult::peak_factor, errors.peak_factor);
  auto loss = Json::array(), loss_error = loss, back = loss;
  for (const auto& b : kind.branches) {
    loss.push_back(json_number(b.contact_loss.value));
    loss_error.push_back(json_number(b.contact_loss.error));
    back.push_back(json_number(b.back_flanks));
  }
  ring["contact_loss"][mesh] = std::move(loss);
  ring["contact_loss_error"][mesh] = std::move(loss_error);
  ring["back_flanks"][mesh] = std::move(back);
}

double worst(const MeshResult& a, const MeshResult& b, const std::string& fact) {
  const double x = a.fact(fact), y = b.fact(fact);
  if (std::isnan(x)) return y;
  return std::isnan(y) ? x : std::max(x, y);
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Json ring_json(const RunResult& result, std::size_t number) {
  const auto& ring = result.rings[number];
  const auto& sun_mesh = result.sun_mesh;
  Json json = {
      {"model", ring.mesh.model.fidelity}, {"ring_planet", mesh_json(ring.mesh)}, {"sun_planet", mesh_json(sun_mesh)}};
  json["invariants"] = {{"force_balance_relative", json_number(worst(ring.mesh, sun_mesh, "force_balance_relative"))},
                        {"energy_balance_relative", json_number(worst(ring.mesh, sun_mesh, "energy_balance_relative"))},
                        {"max_penetration_m", json_number(worst(ring.mesh, sun_mesh, "max_penetration_m"))},
                        {"closure_relative", json_number(worst(ring.mesh, sun_mesh, "closure_relative"))},
                        {"reciprocity_relative", json_number(worst(ring.mesh, sun_mesh, "reciprocity_relative"))}};
  if (const auto readings = gauge_readings(result.scene, result.geometry.rings[number].set, ring.mesh))
    json["strain_gauges"] = to_json(result.scene, *readings);
  for (const auto& [name, mesh, made] : {std::tuple{"sun_planet", &sun_mesh, &result.geometry.rings.front()},
                                         {"ring_planet", &ring.mesh, &result.geometry.rings[number]}})
    if (const auto loads = roller_loads(result.scene, made->set, *mesh))
      json["planet_rollers"][name] = {
          {"largest_N_per_deg", loads->largest * units::deg},
          {"largest_over_round_rim", loads->largest / loads->largest_rigid},
          {"load_zone_deg", loads->load_zone / units::deg},
          {"load_zone_of_round_rim_deg", loads->rigid_load_zone / units::deg},
          {"deflection_by_other_mesh_m_per_N", json_number(mean(mesh->partner_compliance))}};
  if (ring.tolerances) json["load_sharing_of_assemblies"] = to_json(*ring.tolerances);
  if (!ring.response) return json;
  const auto& f = ring.response->figures;
  const auto& errors = ring.response->errors;
  json["load_sharing"] = {{"sun_planet", sharing_json(f.sun_planet.load_sharing, errors.sun_planet)},
                          {"ring_planet", sharing_json(f.ring_planet.load_sharing, errors.ring_planet)}};
  add_branches(json, sun_planet, f.sun_planet, errors.sun_planet);
  add_branches(json, ring_planet, f.ring_planet, errors.ring_planet);
  json["natural_frequencies_Hz"] = Json::array();
  for (const auto& mode : ring.response->modes.list)
    json["natural_frequencies_Hz"].push_back({{"value", mode.frequency},
                                              {"error", json_number(mode.frequency_error)},
                                              {"error_parts", to_json(mode.error_parts)},
                                              {"kind", mode.kind}});
  const auto& m = ring.response->motion;
  json["bearing_forces"] = {{"planet_max_N", m.pin_force_max},
                            {"planet_mean_tangential_N", m.pin_force_mean_tangential},
                            {"load_zone_min_deg", json_number(m.load_zone_min / units::deg)},
                            {"sun_support_max_N", json_number(m.sun_support_max)},
                            {"ring_support_max_N", json_number(m.ring_support_max)},
                            {"carrier_support_max_N", json_number(m.carrier_support_max)},
                            {"held_torque_mean_N_m", json_number(m.held_torque_mean)}};
  add_json(json, m.space);
  json["sun_orbit"] = {{"extent_m", json_number(m.sun_orbit_extent)}, {"largest_m", json_number(m.sun_orbit_largest)}};
  json["poincare"] = {{"section", m.section},
                      {"period_cycles", m.section_period ? Json(*m.section_period) : Json(nullptr)},
                      {"clusters", m.section_clusters}};
  json["motions"] = to_json(f.motions);
  if (!f.shafts.empty()) json["shafts"] = to_json(f.shafts);
  json["dynamics"] = {{"steady", f.steady},
                      {"steady_difference", json_number(f.steady_difference)},
                      {"window_cycles", f.window_cycles},
                      {"whole_error_period", f.whole_period},
                      {"total_cycles", f.total_cycles},
                      {"energy_balance_relative", json_number(f.energy.relative)},
                      {"force_balance_relative", json_number(f.force_balance_relative)},
                      {"reused", ring.response->reused}};
  return json;
}

}  // namespace

Json stage_summary(const RunResult& result) {
  const auto& point = result.geometry.operating_point;
  Json json = {{"operating_point",
                {{"sun_torque_N_m", point.sun_torque},
                 {"mesh_frequency_Hz", point.mesh_frequency},
                 {"mean_mesh_force_N", point.mean_mesh_force}}}};
  for (const auto member : stage_members)
    json["operating_point"]["members"][to_string(member)] = {{"role", role_of(result.scene, point, member)},
                                                             {"speed_rad_per_s", point.flow.speed[member]},
                                                             {"torque_N_m", point.flow.torque[member]},
                                                             {"power_W", point.flow.power(member)}};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    auto& entry = json["rings"][result.rings[i].name] = ring_json(result, i);
    entry.update(variant_studies_json(result.studies, i));
  }
  return json;
}

std::string stage_text(const RunResult& result) { return key_results_text(result); }

}  // namespace annulus::app
