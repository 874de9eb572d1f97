#include "app/systems/planetary/back_flanks.h"

#include <fmt/format.h>

namespace annulus::app {

namespace {

std::string warning(const char* mesh, std::size_t planet, const dynamics::BranchResult& branch) {
  // The stiffness of back flanks has the same mean; over the mesh cycle it is the mirror image of that of the driving
  // flanks.
  return fmt::format(
      "the back flanks of planet {} carry load in its {} for {:.3g} % of the time (mean force {:.4g} kN). They are "
      "computed with the stiffness of the driving flanks at the same phase: its mean is right, its course over the "
      "mesh "
      "cycle is not. A larger dynamics.half_backlash_um or smaller errors avoid this",
      planet + 1, mesh, 100 * branch.back_flanks, branch.mean_force / 1e3);
}

}  // namespace

std::vector<std::string> back_flank_warnings(const dynamics::DynamicResponse& response) {
  std::vector<std::string> list;
  for (const auto& [mesh, kind] : {std::pair{"sun mesh", &response.sun_planet}, {"ring mesh", &response.ring_planet}})
    for (std::size_t n = 0; n < kind->branches.size(); ++n)
      if (kind->branches[n].back_flanks > 0) list.push_back(warning(mesh, n, kind->branches[n]));
  return list;
}

}  // namespace annulus::app
