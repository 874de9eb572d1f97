#include <fmt/format.h>

#include "app/report/drawings/dimension.h"
#include "app/report/drawings/teeth.h"
#include "app/report/drawings/transverse_section.h"
#include "app/sections/geometry_parts.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/report/pair_report_parts.h"
#include "core/units.h"
#include "geometry/gear_places.h"

namespace annulus::app {

namespace {

Section pair_drawings(const PairRunResult& result) {
  const auto& gears = result.geometry.gears;
  const auto& scene = result.scene;
  const auto stand = geometry::pair_places(gears);
  const Eigen::Vector2d axis(0, 0), centre(gears.centre_distance(), 0);
  TransverseSection section{
      .title = "Pinion and wheel: transverse section",
      .label = fmt::format("Pinion and wheel: transverse section to scale, {} and {} teeth, centre distance {} mm",
                           gears.pinion().teeth(), gears.wheel().teeth(), mm_text(gears.centre_distance()))};
  section.gears.push_back({{.gear = gears.wheel(),
                            .id = "pair-wheel",
                            .fill = sun_fill,
                            .inner_radius = bore_radius(helical_pair(scene).wheel)},
                           {{axis, stand.wheel}}});
  section.gears.push_back({{.gear = gears.pinion(),
                            .id = "pair-pinion",
                            .fill = planet_fill,
                            .inner_radius = bore_radius(helical_pair(scene).pinion)},
                           {{centre, stand.pinion}}});
  section.lengths.push_back({axis, centre, 0, "a = "});
  return geometry_section(Pictures{{drawn(section), drawn(TeethInMesh{.title = "Pinion and wheel in mesh",
                                                                      .id = "pair-teeth",
                                                                      .pinion_name = "pinion",
                                                                      .wheel_name = "wheel"},
                                                          gears)},
                                   {},
                                   "All lengths in millimetres. Left: the pair. Right: its " +
                                       teeth_words("pinion", "wheel") + helical_note(scene.stage.helix_angle)} +
                          diameter_table({{"pinion", gears.pinion(), bore_radius(helical_pair(scene).pinion)},
                                          {"wheel", gears.wheel(), bore_radius(helical_pair(scene).wheel)}}));
}

Section pair_results(const PairRunResult& result) {
  const auto& stage = helical_pair(result.scene).stage;
  std::string conditions =
      fmt::format("At {} and {} r/min of the pinion, error at mesh frequency {}. ",
                  text_in_unit(stage.pinion_torque, shown_units::torque), to_text(stage.pinion_speed / units::rpm, 6),
                  text_in_unit(result.errors.amplitude, shown_units::length));
  if (result.response)
    conditions += fmt::format("Static mesh force along the normal of the flanks {}. ",
                              text_in_unit(result.response->figures.static_force, shown_units::force, 5));
  if (result.mesh.table && !result.mesh.computed) conditions += "The error of the stiffness table is not known. ";
  return key_results(result,
                     {{"pinion_wheel_", "Mesh along the transverse line of action"},
                      {"acceleration_", "Largest accelerations"},
                      {"transmission_error_", "Transmission error u₁ + u₂ at the base circles"},
                      {"relative_motion_", "With the bending of shafts and bearings, y₁ + u₁ – y₂ + u₂"},
                      {"frequency_", "Natural frequencies"},
                      {"", "Mesh along the normal of the flanks"}},
                     conditions);
}

}  // namespace

Page pair_report(const PairRunResult& result) {
  const auto& scene = result.scene;
  NamedMeshes meshes;
  if (result.mesh.computed) meshes.emplace_back("Pinion and wheel", &*result.mesh.computed);
  return run_page(
      result,
      {.words = fmt::format(
           "{} and {} teeth, {} N m at {} r/min of the pinion, mesh frequency {} Hz", helical_pair(scene).pinion.teeth,
           helical_pair(scene).wheel.teeth, to_text(helical_pair(scene).stage.pinion_torque),
           to_text(helical_pair(scene).stage.pinion_speed / units::rpm, 6),
           to_text(helical_pair(scene).pinion.teeth * helical_pair(scene).stage.pinion_speed / units::rpm / 60, 6)),
       .answer = pair_verdict(result),
       .results = {pair_drawings(result), pair_results(result), pair_conclusions_section(result),
                   pair_errors_section(result), pair_shares_section(result)},
       .meshes = meshes,
       .sections = {pair_stiffness_section(result, meshes), contact_section(meshes), pair_motion_section(result),
                    pair_modes_section(result)},
       .checks = result.response ? solution_checks({{"pair", &result.response->figures}}) : Blocks()});
}

}  // namespace annulus::app
