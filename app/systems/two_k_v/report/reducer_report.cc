#include "app/systems/two_k_v/report/reducer_report_parts.h"

#include <fmt/format.h>

#include "app/systems/two_k_v/two_k_v_input.h"
#include "core/units.h"

namespace annulus::app {

namespace {

NamedMeshes case_meshes(const TwoKVResult& result) {
  NamedMeshes meshes;
  const auto cases = shown_cases(result);
  for (const auto& [name, mesh] : {std::pair{"Sun mesh", &TwoKVTables::sun}, {"Arc mesh", &TwoKVTables::arc}})
    for (const auto& [of, shown] : cases)
      meshes.emplace_back(std::string(name) + (cases.size() > 1 ? ", " + of : ""), &(shown->tables.*mesh));
  return meshes;
}

}  // namespace

NamedCases shown_cases(const TwoKVResult& result) {
  NamedCases cases = {{"as in the scene", &result.own}};
  if (result.computed) cases.emplace_back("computed stiffness", &*result.computed);
  return cases;
}

Page reducer_report(const TwoKVResult& result) {
  const auto& scene = result.scene;
  NamedMeshes solved;
  const SystemRun& run = result;
  for (const auto* mesh : run.meshes()) solved.emplace_back("Sun mesh", mesh);
  return run_page(
      run,
      {.words =
           fmt::format("ratio {}, {} N m at {} r/min of the output", to_text(two_k_v_kinematics(scene).ratio(), 6),
                       to_text(two_k_v(scene).output.torque, 5), to_text(two_k_v(scene).output.speed / units::rpm, 5)),
       .answer = reducer_verdict(result),
       .results = {drawings_section(result),
                   key_results(result,
                               {{"sun_planet_", "Sun meshes"},
                                {"arc_", "Arc meshes"},
                                {"frequency_", "Natural frequencies"},
                                {"", "Output"}},
                               ""),
                   reducer_comparison(result)},
       .meshes = solved,
       .sections = {frequencies_section(result),
                    first_frequency_section(result),
                    torsion_section(result),
                    reducer_motion_section(result),
                    {"stiffness", "Mesh stiffness",
                     paragraph("Stiffness at the load of the scene: of one involute mesh along its line of action, of "
                               "one arc gear along the tangent at the pitch point.") +
                         stiffness_blocks(case_meshes(result)) + arc_pins_blocks(result)},
                    contact_section(solved)},
       .checks = motion_checks(result)});
}

}  // namespace annulus::app
