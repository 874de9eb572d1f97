#include <fmt/format.h>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "app/systems/planetary/rim_coupling.h"

namespace annulus::app {

namespace {

const char* coupling_name(RimCoupling model) {
  return model == RimCoupling::statical ? "static" : model == RimCoupling::elastic ? "elastic modes" : "none";
}

}  // namespace

Section coupling_section(const RunResult& result) {
  PageTable size, effect;
  size.head = {"ring", "largest deflection under the load of another mesh / under its own load",
               "first elastic mode of the ring, Hz (waves)", "coupling applied", "reason"};
  for (const auto* head : {"ring", "coupling", "load sharing, averaged", "instantaneous", "quasi-static",
                           "peak factor, sun meshes", "peak factor, ring meshes"})
    effect.head.emplace_back(head);
  int cycles = 0;
  std::vector<std::string> negligible;
  for (const auto& ring : result.rings) {
    if (!ring.mesh.coupling) continue;
    const auto& solved = *ring.mesh.coupling;
    const auto choice = coupling_choice(result.scene, solved);
    const auto& modes = solved.coupling.modes;
    size.rows.push_back({ring.name,
                         fmt::format("{:.2g} % ± {:.1g} %", 100 * solved.largest() / solved.mesh_compliance,
                                     100 * solved.compliance_error / solved.mesh_compliance),
                         modes.empty() ? fmt::format("none below {:.0f}", solved.highest_frequency)
                                       : fmt::format("{:.0f} ({})", modes.front().frequency, modes.front().waves),
                         coupling_name(choice.taken), choice.reason});
    if (is_negligible(result.scene, solved)) negligible.push_back(ring.name);
    if (!ring.coupling_effect) continue;
    cycles = ring.coupling_effect->cycles;
    for (const auto& row : ring.coupling_effect->rows) {
      auto& cells = effect.rows.emplace_back(std::vector<Text>{ring.name, coupling_name(row.model)});
      for (const double x : {row.averaged, row.instantaneous, row.quasi_static, row.sun_factor, row.ring_factor})
        cells.emplace_back(fmt::format("{:.4f}", x));
    }
  }
  Section section{"coupling", "Coupling through the ring", {}, "Coupling of the planets through the ring"};
  if (size.rows.empty()) return section;
  section.blocks =
      paragraph(
          "The load of one planet deflects the ring at all other planets. The stiffness table of a single mesh does "
          "not contain this effect. The compliances between the meshes at every ring position contain it.") +
      size;
  if (!effect.rows.empty())
    section.blocks += paragraph(fmt::format("Effect of the coupling. All rows were integrated in time with the same "
                                            "settings and evaluated over {} mesh cycles. These cycles need not be a "
                                            "whole period. Compare the rows with each other, not with the key results.",
                                            cycles)) +
                      effect;
  if (!effect.rows.empty() && planetary(result.scene).stage.held != geometry::StageMember::ring)
    section.blocks +=
        paragraph("Elastic modes are not compared: the ring turns, and they would need its Coriolis forces.");
  if (!negligible.empty())
    section.blocks += paragraph(
        fmt::format("The effect was not computed for '{}': the coupling is less than a tenth of the wanted accuracy.",
                    fmt::join(negligible, "', '")));
  return section;
}

}  // namespace annulus::app
