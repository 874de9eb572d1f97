#include <fmt/format.h>

#include "app/systems/helical_pair/report/pair_report_parts.h"
#include "core/units.h"

namespace annulus::app {

Page pair_report(const PairRunResult& result) {
  const auto& scene = result.scene;
  const MeshResult* computed = result.mesh.computed ? &*result.mesh.computed : nullptr;
  return scene_page(scene,
                    fmt::format("{} and {} teeth, {} N m at {} r/min of the pinion, mesh frequency {} Hz",
                                scene.pinion.teeth, scene.wheel.teeth, to_text(scene.stage.pinion_torque),
                                to_text(scene.stage.pinion_speed / units::rpm, 6),
                                to_text(scene.pinion.teeth * scene.stage.pinion_speed / units::rpm / 60, 6)),
                    pair_verdict(result),
                    {{drawings_section(result), pair_figures_section(result), pair_conclusions_section(result),
                      pair_errors_section(result), pair_maps_section(result), pair_shares_section(result),
                      fields_section({{"Pinion and wheel", computed}}), pair_stiffness_section(result),
                      pair_motion_section(result), pair_modes_section(result)},
                     study_sections(scene, result.studies),
                     {model_section(result.plan), inputs_section(result.plan), pair_quality_section(result)}});
}

}  // namespace annulus::app
