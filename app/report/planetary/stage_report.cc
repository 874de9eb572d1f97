#include <fmt/format.h>

#include "app/content_id.h"
#include "app/report/planetary/stage_report_parts.h"
#include "app/report/report.h"
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

Page stage_report(const RunResult& result) {
  const auto& scene = result.scene;
  const auto meshes = titled_meshes(result);
  Page page{.title = scene.title,
            .sub = phrase("annulus {} · scene {} · {} planets, {} kW at {} r/min of the sun", version(),
                          code(scene.file.filename().string()), scene.stage.planets, to_text(scene.stage.power / 1e3),
                          to_text(result.geometry.operating_point.sun_speed / units::rpm, 6)),
            .summary = stage_verdict(result),
            .sections = {drawings_section(result),
                         key_figures_section(result),
                         comparison_section(result),
                         {"meshes", "Meshes", mesh_pictures(meshes)},
                         fields_section(meshes),
                         stiffness_section(result),
                         supports_section(result),
                         contact_section(result),
                         dynamics_section(result)}};
  for (auto& section : study_sections(scene, result.studies)) page.sections.push_back(std::move(section));
  for (const auto& section : {coupling_section(result), motion_section(result), modes_section(result),
                              model_section(result.plan), inputs_section(result.plan), quality_section(result)})
    page.sections.push_back(section);
  return page;
}

}  // namespace annulus::app
