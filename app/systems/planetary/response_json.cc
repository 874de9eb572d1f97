#include "app/results/content_id.h"
#include "app/systems/planetary/stage_response.h"
#include "core/json.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

namespace {

Json kind_json(const StageResponse& response, const dynamics::StageMeshKind& kind) {
  const auto& [sharing, branches] = response.figures.*kind.results;
  const auto parts = [&](const std::string& key) { return response.errors.find(key)->parts; };
  Json json;
  for (const auto& quantity : dynamics::sharing_quantities)
    json["load_sharing"][quantity.name] =
        to_json(sharing.*quantity.value, parts(dynamics::sharing_key(kind.name, quantity)));
  for (std::size_t n = 0; n < branches.size(); ++n) {
    const auto& branch = branches[n];
    Json item;
    for (const auto& quantity : dynamics::branch_quantities)
      item[quantity.name] = to_json(branch.*quantity.value, parts(dynamics::branch_key(kind.name, n, quantity)));
    item["smallest_factor"] = json_number(branch.smallest_factor);
    item["mean_force_N"] = json_number(branch.mean_force);
    item["back_flanks"] = json_number(branch.back_flanks);
    json["branches"].push_back(std::move(item));
  }
  return json;
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

Json motion_json(const StageMotion& m) {
  return {{"section", m.section},
          {"section_period_cycles", m.section_period ? Json(*m.section_period) : Json(nullptr)},
          {"section_clusters", m.section_clusters}};
}

Json periodic_json(const std::optional<dynamics::PeriodicSolution>& periodic) {
  if (!periodic) return nullptr;
  constexpr const char* methods[] = {"harmonic_balance", "two_frequencies", "piecewise"};
  return {{"method", methods[static_cast<int>(periodic->method)]},
          {"converged", periodic->converged},
          {"trouble", periodic->trouble},
          {"newton_iterations", periodic->newton_iterations},
          {"linear_iterations", periodic->linear_iterations},
          {"residual", json_number(periodic->residual)},
          {"sampling_difference", json_number(periodic->sampling_difference)},
          {"largest_multiplier", json_number(periodic->largest_multiplier)}};
}

}  // namespace

Json response_json(const StageResponse& response, const std::string& id) {
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
               {"periodic_solution", periodic_json(f.periodic)},
               {"integrator_reason", f.integrator ? Json(f.integrator->reason) : Json(nullptr)},
               {"energy_balance_relative", json_number(f.energy.relative)},
               {"force_balance_relative", json_number(f.force_balance_relative)},
               {"steps", f.statistics.steps},
               {"contact_events", f.statistics.contact_events}};
  for (const auto& kind : dynamics::stage_mesh_kinds) json[kind.name] = kind_json(response, kind);
  json["modes"] = modes_json(response.modes);
  json["motion"] = motion_json(response.motion);
  json["bodies"] = to_json(f.bodies);
  return json;
}

}  // namespace annulus::app
