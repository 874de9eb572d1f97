#include <fmt/format.h>

#include "app/content_id.h"
#include "app/report/pair_report_parts.h"
#include "app/report/report_drawings.h"
#include "core/units.h"

namespace annulus::app {

std::string pair_report_html(const PairRunResult& result) {
  const auto& scene = result.scene;
  const std::string sub = fmt::format(
      "annulus {} · scene <code>{}</code> · {} and {} teeth, {} N m at {} r/min of the "
      "pinion, mesh frequency {} Hz",
      version(), escape(scene.file.filename().string()), scene.pinion.teeth, scene.wheel.teeth,
      to_text(scene.stage.pinion_torque), to_text(scene.stage.pinion_speed / units::rpm, 6),
      to_text(scene.pinion.teeth * scene.stage.pinion_speed / units::rpm / 60, 6));
  return report_page(
      escape(scene.title), sub, pair_verdict(result),
      {{{"drawings", "Geometry", drawings_section(result)},
        {"figures", "Key figures", pair_figures_section(result)},
        {"conclusions", "The paper's conclusions", pair_conclusions_section(result)},
        {"errors", "Manufacturing errors", pair_errors_section(result)},
        {"maps", "Torque and speed", pair_maps_section(result)},
        {"shares", "Causes of the transmission error", pair_shares_section(result)},
        {"fields", "Deformation and stress",
         fields_section({{"Pinion and wheel", result.mesh.computed ? &*result.mesh.computed : nullptr}})},
        {"stiffness", "Mesh stiffness", pair_stiffness_section(result)},
        {"motion", "Time history", pair_motion_section(result)},
        {"modes", "Natural frequencies", pair_modes_section(result)}},
       study_sections(scene, result.studies),
       {{"model", "What was modelled", model_section(result.plan)},
        {"inputs", "Inputs", inputs_section(result.plan)},
        {"quality", "Checks and cost", pair_quality_section(result)}}});
}

}  // namespace annulus::app
