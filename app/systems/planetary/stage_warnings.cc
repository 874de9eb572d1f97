#include "app/systems/planetary/stage_warnings.h"

#include <fmt/format.h>

#include <algorithm>

namespace annulus::app {

namespace {

std::string back_flanks(const char* mesh, std::size_t planet, const dynamics::BranchResult& branch) {
  return fmt::format(
      "the back flanks of planet {} carry load in its {} for {:.3g} % of the time (mean force {:.4g} kN). Their "
      "stiffness is the mirror image over the mesh cycle of that of the driving flanks; if a scene prescribes it, or "
      "on "
      "single supports, it is that of the driving flanks at the same phase, of which only the mean is right. A larger "
      "dynamics.half_backlash_um or smaller errors avoid this",
      planet + 1, mesh, 100 * branch.back_flanks, branch.mean_force / 1e3);
}

bool by_default(const Scene& scene, const std::string& key) {
  return std::any_of(scene.inputs.begin(), scene.inputs.end(),
                     [&](const Input& input) { return input.key == key && input.origin == Origin::default_value; });
}

/// A floating sun or soft planet bearings even out what planets carry; a scene that mentions neither hardly means to
/// have none of it.
bool rigid_unasked(const Scene& scene) {
  return scene.stage.planets > 1 && by_default(scene, "supports.sun_N_per_m") &&
         by_default(scene, "supports.planet_N_per_m");
}

}  // namespace

std::vector<std::string> stage_warnings(const Scene& scene, const dynamics::DynamicResponse& response) {
  std::vector<std::string> list;
  if (rigid_unasked(scene))
    list.emplace_back(
        "sun and planets are in rigid bearings, because [supports] does not mention them: nothing but the meshes evens "
        "out what the planets carry. Load sharing and dynamic factors are those of such a stage; give "
        "supports.sun_N_per_m (0: floating) and supports.planet_N_per_m");
  for (const auto& [mesh, kind] : {std::pair{"sun mesh", &response.sun_planet}, {"ring mesh", &response.ring_planet}})
    for (std::size_t n = 0; n < kind->branches.size(); ++n)
      if (kind->branches[n].back_flanks > 0) list.push_back(back_flanks(mesh, n, kind->branches[n]));
  return list;
}

}  // namespace annulus::app
