#include "app/systems/planetary/stage_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace annulus::app {

namespace {

/// Of all planets whose back flanks carry load in one kind of mesh; empty where none do.
std::string back_flanks(const char* mesh, const std::vector<dynamics::BranchResult>& branches) {
  std::vector<std::string> planets;
  double longest = 0;
  for (std::size_t n = 0; n < branches.size(); ++n) {
    if (!(branches[n].back_flanks > 0)) continue;
    planets.push_back(fmt::format("{} (mean force {:.4g} N)", n + 1, branches[n].mean_force));
    longest = std::max(longest, branches[n].back_flanks);
  }
  if (planets.empty()) return "";
  return fmt::format(
      "back flanks carry load in the {} of planet {}, for up to {:.3g} % of the time. Where the stiffness comes from a "
      "table that repeats with every mesh cycle, theirs is its mirror image. Otherwise it is that of the driving "
      "flanks at the same phase, of which only the mean is right. A larger dynamics.half_backlash_um or smaller errors "
      "avoid this",
      mesh, fmt::join(planets, ", "), 100 * longest);
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
        "out what the planets carry. Load sharing, dynamic and peak factors are those of such a stage; give "
        "supports.sun_N_per_m (0: floating) and supports.planet_N_per_m");
  for (const auto& [mesh, kind] : {std::pair{"sun mesh", &response.sun_planet}, {"ring mesh", &response.ring_planet}})
    if (auto warning = back_flanks(mesh, kind->branches); !warning.empty()) list.push_back(std::move(warning));
  return list;
}

}  // namespace annulus::app
