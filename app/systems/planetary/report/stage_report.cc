#include <fmt/format.h>

#include "app/systems/planetary/report/stage_report_parts.h"
#include "core/units.h"

namespace annulus::app {

std::vector<std::pair<std::string, const MeshResult*>> all_meshes(const RunResult& result) {
  std::vector<std::pair<std::string, const MeshResult*>> list;
  for (const auto& ring : result.rings) list.emplace_back(ring.name, &ring.mesh);
  list.emplace_back("sun mesh", &result.sun_mesh);
  return list;
}

std::vector<std::pair<std::string, const MeshResult*>> sun_then_rings(const RunResult& result,
                                                                      const std::string& ring_head) {
  std::vector<std::pair<std::string, const MeshResult*>> list = {{"sun mesh", &result.sun_mesh}};
  for (const auto& ring : result.rings) list.emplace_back(ring_head + ring.name, &ring.mesh);
  return list;
}

std::vector<std::pair<std::string, const MeshResult*>> titled_meshes(const RunResult& result) {
  std::vector<std::pair<std::string, const MeshResult*>> list;
  for (const auto& ring : result.rings) list.emplace_back("Ring mesh, " + ring.name, &ring.mesh);
  list.emplace_back("Sun mesh", &result.sun_mesh);
  return list;
}

std::vector<const RingResult*> rings_with_response(const RunResult& result) {
  std::vector<const RingResult*> list;
  for (const auto& ring : result.rings)
    if (ring.response) list.push_back(&ring);
  return list;
}

Legend planet_legend(int planets) {
  Legend legend;
  for (int n = 0; n < planets; ++n) legend.emplace_back(fmt::format("planet {}", n + 1), static_cast<std::size_t>(n));
  return legend;
}

Pictures planet_lines(const RunResult& result, const PlanetLines& lines, const Text& caption) {
  const int planets = result.scene.stage.planets;
  std::vector<Plot> plots;
  RangeFinder range;
  if (lines.level) range.add(*lines.level);
  for (const auto* ring : rings_with_response(result)) {
    const Csv& csv = lines.table(*ring->response);
    Plot plot{.title = ring->name, .x_label = "mesh cycle of the evaluated window", .y_label = lines.y_label};
    if (lines.level) plot.levels.emplace_back(*lines.level, "");
    for (int n = 0; n < planets; ++n) {
      const auto values = [&](const std::string& suffix) {
        return column_values(csv, fmt::format("{}{}{}", lines.stem, n + 1, suffix), lines.cycles, lines.scale);
      };
      Series series{.label = fmt::format("planet {}", n + 1),
                    .x = column_values(csv, "mesh_cycle", lines.cycles),
                    .y = values(lines.line),
                    .colour = static_cast<std::size_t>(n)};
      if (!lines.low.empty()) {
        series.low = values(lines.low);
        series.high = values(lines.high);
      }
      for (const auto* list : {&series.y, &series.low, &series.high}) range.add(*list);
      plot.series.push_back(std::move(series));
    }
    plots.push_back(std::move(plot));
  }
  return {on_one_scale(plots, range), planet_legend(planets), caption};
}

Page stage_report(const RunResult& result) {
  const auto& scene = result.scene;
  const auto meshes = titled_meshes(result);
  return scene_page(
      scene,
      fmt::format("{} planets, {} kW at {} r/min of the sun", scene.stage.planets, to_text(scene.stage.power / 1e3),
                  to_text(result.geometry.operating_point.sun_speed / units::rpm, 6)),
      stage_verdict(result),
      {{drawings_section(result), key_figures_section(result), comparison_section(result),
        Section{"meshes", "Meshes", mesh_pictures(meshes)}, fields_section(meshes), stiffness_section(result),
        supports_section(result), contact_section(result), dynamics_section(result)},
       study_sections(scene, result.studies),
       {coupling_section(result), motion_section(result), modes_section(result), model_section(result.plan),
        inputs_section(result.plan), quality_section(result)}});
}

}  // namespace annulus::app
