#include <fmt/format.h>

#include "app/content_id.h"
#include "app/report/helical_pair/pair_report_parts.h"
#include "core/units.h"

namespace annulus::app {

Page pair_report(const PairRunResult& result) {
  const auto& scene = result.scene;
  const MeshResult* computed = result.mesh.computed ? &*result.mesh.computed : nullptr;
  Page page{
      .title = scene.title,
      .sub = phrase("annulus {} · scene {} · {} and {} teeth, {} N m at {} r/min of the pinion, mesh frequency {} Hz",
                    version(), code(scene.file.filename().string()), scene.pinion.teeth, scene.wheel.teeth,
                    to_text(scene.stage.pinion_torque), to_text(scene.stage.pinion_speed / units::rpm, 6),
                    to_text(scene.pinion.teeth * scene.stage.pinion_speed / units::rpm / 60, 6)),
      .summary = pair_verdict(result),
      .sections = {drawings_section(result), pair_figures_section(result), pair_conclusions_section(result),
                   pair_errors_section(result), pair_maps_section(result), pair_shares_section(result),
                   fields_section({{"Pinion and wheel", computed}}), pair_stiffness_section(result),
                   pair_motion_section(result), pair_modes_section(result)}};
  for (auto& section : study_sections(scene, result.studies)) page.sections.push_back(std::move(section));
  for (const auto& section : {model_section(result.plan), inputs_section(result.plan), pair_quality_section(result)})
    page.sections.push_back(section);
  return page;
}

}  // namespace annulus::app
