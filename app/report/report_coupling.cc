#include <fmt/format.h>

#include "app/report/report_parts.h"

namespace annulus::app {

namespace {

std::string name_of(RimCoupling model) {
  switch (model) {
    case RimCoupling::statical:
      return "static";
    case RimCoupling::elastic:
      return "elastic modes";
    case RimCoupling::automatic:
    case RimCoupling::none:
      break;
  }
  return "none";
}

}  // namespace

std::string coupling_section(const RunResult& result) {
  HtmlTable size, effect;
  size.head = {"ring", "another mesh's load moves a mesh by at most, of what its own does",
               "first elastic mode of the ring, Hz (waves)", "taken", "why"};
  effect.head = {"ring",
                 "coupling",
                 "load sharing, averaged",
                 "instantaneous",
                 "quasi-static",
                 "dynamic factor, sun meshes",
                 "dynamic factor, ring meshes"};
  int cycles = 0;
  std::vector<std::string> negligible;
  for (const auto& ring : result.rings) {
    if (!ring.mesh.coupling) continue;
    const auto& solved = *ring.mesh.coupling;
    const auto choice = coupling_choice(result.scene, solved);
    const auto& modes = solved.coupling.modes;
    size.rows.push_back({escape(ring.name),
                         fmt::format("{:.2g} % ± {:.1g} %", 100 * solved.largest() / solved.mesh_compliance,
                                     100 * solved.compliance_error / solved.mesh_compliance),
                         modes.empty() ? fmt::format("none below {:.0f}", solved.highest_frequency)
                                       : fmt::format("{:.0f} ({})", modes.front().frequency, modes.front().waves),
                         name_of(choice.taken), escape(choice.reason)});
    if (is_negligible(result.scene, solved)) negligible.push_back(ring.name);
    if (!ring.coupling_effect) continue;
    cycles = ring.coupling_effect->cycles;
    for (const auto& row : ring.coupling_effect->rows)
      effect.rows.push_back({escape(ring.name), name_of(row.model), fmt::format("{:.4f}", row.averaged),
                             fmt::format("{:.4f}", row.instantaneous), fmt::format("{:.4f}", row.quasi_static),
                             fmt::format("{:.4f}", row.sun_factor), fmt::format("{:.4f}", row.ring_factor)});
  }
  if (size.rows.empty()) return "";
  std::string text =
      "<section id=\"coupling\"><h2>Coupling of the planets through the ring</h2>\n"
      "<p>A load at one planet moves the ring at all others. The stiffness table of a single mesh does not know that; "
      "the compliance between the meshes at every ring position does.</p>\n" +
      html(size);
  if (!effect.rows.empty())
    text +=
        fmt::format(
            "<p>What it changes. All rows were marched alike and evaluated over {} mesh cycles, which need not be a "
            "whole period: they compare with each other, not with the key figures.</p>\n",
            cycles) +
        html(effect);
  if (!negligible.empty())
    text += fmt::format("<p>What it changes was not looked at for {}: less than a tenth of the wanted accuracy.</p>\n",
                        escape(fmt::format("'{}'", fmt::join(negligible, "', '"))));
  return text + "</section>\n";
}

}  // namespace annulus::app
