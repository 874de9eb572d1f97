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
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

namespace {

Json estimate_json(const Estimate& e) {
  return {{"value", json_number(e.value)},
          {"error_relative", json_number(e.error_relative)},
          {"error_parts_relative", to_json(e.parts)}};
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

/// Load sharing, and the results of every mesh as lists over the planets.
void add_mesh_results(Json& ring, const StageResponse& response, const dynamics::StageMeshKind& kind) {
  const auto& [sharing, branches] = response.figures.*kind.results;
  const std::string mesh = kind.name;
  for (const auto& quantity : dynamics::sharing_quantities)
    ring["load_sharing"][mesh][quantity.name] =
        to_json(sharing.*quantity.value, response.errors.find(dynamics::sharing_key(mesh, quantity))->parts);
  for (const auto& quantity : dynamics::branch_quantities) {
    auto value = Json::array(), error = value, parts = value;
    for (std::size_t n = 0; n < branches.size(); ++n) {
      const auto& figure = branches[n].*quantity.value;
      value.push_back(json_number(figure.value));
      error.push_back(json_number(figure.error));
      parts.push_back(to_json(response.errors.find(dynamics::branch_key(mesh, n, quantity))->parts));
    }
    ring[quantity.name][mesh] = std::move(value);
    ring[fmt::format("{}_error", quantity.name)][mesh] = std::move(error);
    ring[fmt::format("{}_error_parts", quantity.name)][mesh] = std::move(parts);
  }
  auto back = Json::array();
  for (const auto& branch : branches) back.push_back(json_number(branch.back_flanks));
  ring["back_flanks"][mesh] = std::move(back);
}

/// Lists over the planets, and the largest forces of supports; all with their errors among the results of the variant.
Json bearing_forces_json(const FigureSet& bodies) {
  auto largest = Json::array(), error = largest, tangential = largest;
  for (std::size_t n = 0; const auto* entry = bodies.find(dynamics::pin_key(n, dynamics::force_of_pin)); ++n) {
    largest.push_back(json_number(entry->figure.value));
    error.push_back(json_number(entry->figure.error));
    tangential.push_back(json_number(bodies.value(dynamics::pin_key(n, dynamics::tangential_force_of_pin))));
  }
  return {{"planet_max_N", std::move(largest)},
          {"planet_max_error_N", std::move(error)},
          {"planet_mean_tangential_N", std::move(tangential)},
          {"load_zone_min_deg", json_number(bodies.value("planet_bearing_load_zone_rad") / units::deg)},
          {"sun_support_max_N", json_number(bodies.value("sun_support_force_N"))},
          {"ring_support_max_N", json_number(bodies.value("ring_support_force_N"))},
          {"carrier_support_max_N", json_number(bodies.value("carrier_support_force_N"))},
          {"held_torque_mean_N_m", json_number(bodies.value("held_torque_Nm"))}};
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
  for (const auto& kind : dynamics::stage_mesh_kinds) add_mesh_results(json, *ring.response, kind);
  json["natural_frequencies_Hz"] = Json::array();
  for (const auto& mode : ring.response->modes.list)
    json["natural_frequencies_Hz"].push_back({{"value", mode.frequency},
                                              {"error", json_number(mode.frequency_error)},
                                              {"error_parts", to_json(mode.error_parts)},
                                              {"kind", mode.kind}});
  const auto& m = ring.response->motion;
  json["bearing_forces"] = bearing_forces_json(f.bodies);
  add_json(json, m.space);
  json["sun_orbit"] = {{"extent_m", json_number(f.bodies.value("sun_orbit_m"))},
                       {"largest_m", json_number(f.bodies.value("sun_distance_m"))}};
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
