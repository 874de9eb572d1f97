#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/power_flow.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

Blocks response_checks(const RunResult& result) {
  std::vector<NamedOutcome> outcomes;
  for (const auto& [name, response] : responses_of(result))
    outcomes.push_back({name, &response->figures, response->figures.force_balance_relative});
  return solution_checks(outcomes);
}

}  // namespace

NamedMeshes named_meshes(const RunResult& result) {
  NamedMeshes list;
  for (const auto& ring : result.rings) list.emplace_back("Ring mesh, " + ring.name, &ring.mesh);
  list.emplace_back("Sun mesh", &result.sun_mesh);
  return list;
}

NamedResponses responses_of(const RunResult& result) {
  NamedResponses list;
  for (const auto& ring : result.rings)
    if (ring.response) list.emplace_back(ring.name, &*ring.response);
  return list;
}

Legend planet_legend(int planets) {
  Legend legend;
  for (int n = 0; n < planets; ++n) legend.emplace_back(fmt::format("planet {}", n + 1), static_cast<std::size_t>(n));
  return legend;
}

namespace {

std::vector<std::string> planet_names(const RunResult& result) {
  std::vector<std::string> names;
  for (const auto& [label, colour] : planet_legend(responses_of(result).empty() ? 0 : result.scene.stage.planets))
    names.push_back(label);
  return names;
}

Section power_flow_section(const RunResult& result) {
  const auto& point = result.geometry.operating_point;
  PageTable table{.head = {"", "role", "speed, r/min", "torque on it, N m", "power into the stage, kW"}};
  for (const auto member : stage_members)
    table.rows.push_back({to_string(member), role_of(result.scene, point, member),
                          to_text(point.flow.speed[member] / units::rpm, 6), to_text(point.flow.torque[member], 6),
                          to_text(point.flow.power(member) / units::kW, 6)});
  return {
      "power-flow", "Power flow",
      table + paragraph(point.mirrored ? "Counter-clockwise is positive. The stage is computed as its mirror image, "
                                         "in which the torque of the sun is counter-clockwise. Directions and "
                                         "drawings below are those of the mirror image."
                                       : "Counter-clockwise is positive.")};
}

}  // namespace

Page stage_report(const RunResult& result) {
  const auto& scene = result.scene;
  const auto& point = result.geometry.operating_point;
  const auto meshes = named_meshes(result);
  return run_page(
      result,
      {.words =
           fmt::format("{} planets, {} kW at {} r/min of the {}", scene.stage.planets, to_text(point.power / 1e3, 6),
                       to_text(std::abs(point.flow.speed[point.driver]) / units::rpm, 6), to_string(point.driver)),
       .answer = stage_verdict(result),
       .results = {key_results(result, {{"ring_planet_", "Ring meshes"}, {"sun_planet_", "Sun meshes"}, {"", "Stage"}},
                               fmt::format("At the nominal mesh force of {}. ",
                                           text_in_unit(point.mean_mesh_force, shown_units::force, 5))),
                   comparison_section(result)},
       .meshes = meshes,
       .sections = {power_flow_section(result),
                    tolerances_section(result),
                    dynamics_section(result),
                    motion_section(result),
                    supports_section(result),
                    rollers_section(result),
                    strain_gauges_section(result),
                    contact_section(meshes),
                    {"stiffness", "Transmission error and stiffness", stiffness_blocks(meshes)},
                    coupling_section(result),
                    modes_section(result)},
       .geometry = {drawings_section(result)},
       .checks = response_checks(result),
       .choices = {sun_meshes, ring_meshes},
       .line_kind = "Planet",
       .lines = planet_names(result)});
}

}  // namespace annulus::app
