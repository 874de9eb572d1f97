#include "app/systems/planetary/stage_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "app/model/scene_warnings.h"
#include "app/systems/planetary/planet_coupling.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/space_dynamics.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/planetary/strain_gauges.h"
#include "app/systems/shared/friction.h"
#include "app/systems/shared/space_input.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/units.h"

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
      "back flanks carry load in the {} of planet {}, for up to {:.3g} % of the time. They have the mirror image of "
      "the driving flanks' stiffness and deviations. For a ring that changes from tooth to tooth this leaves open "
      "where its supports are; "
      "the error bars contain that. A larger dynamics.half_backlash_um or smaller errors avoid this",
      mesh, fmt::join(planets, ", "), 100 * longest);
}

bool by_default(const Scene& scene, const std::string& key) {
  return std::any_of(scene.inputs.begin(), scene.inputs.end(),
                     [&](const Input& input) { return input.key == key && input.origin == Origin::default_value; });
}

/// Supports that the scene does not mention; those of the sun it must.
std::vector<std::string> rigid_unasked(const Scene& scene) {
  std::vector<std::string> keys;
  for (const auto* key : {"supports.planet_N_per_m", "supports.carrier_N_per_m", "supports.ring_N_per_m"})
    if (by_default(scene, key)) keys.emplace_back(key);
  const auto& s = planetary(scene).supports;
  if ((!s.planet_radial.empty() && !s.planet_tangential.empty()) || s.planet_pin != PinMounting::unbending)
    std::erase(keys, "supports.planet_N_per_m");
  for (const auto& [body, key] : {std::pair{dynamics::StageBody::Kind::planet, "supports.planet_N_per_m"},
                                  {dynamics::StageBody::Kind::carrier, "supports.carrier_N_per_m"},
                                  {dynamics::StageBody::Kind::ring, "supports.ring_N_per_m"}})
    if (scene.own<SpaceInput>().has_radial_bearing(body, scene.stage.planets)) std::erase(keys, key);
  return keys;
}

/// Cantilevered pins tilt, which a plane model does not show.
void warn_of_tilting_pins(std::vector<Warning>& list, const Scene& scene, const GearGeometry& geometry) {
  const auto& set = geometry.rings.front().set;
  const double force = geometry.operating_point.mean_mesh_force * pin_force_per_mesh_force(set);
  const double tilt = pin_tilt(scene, force);
  if (!scene.dynamics || tilt == 0 || moves_in_space(scene)) return;
  list.push_back({"pins_tilt", Severity::warning,
                  fmt::format("the cantilevered planet pins tilt under the mean load, by {:.3g} µm over the face width "
                              "of the sun mesh. The lumped model is plane and leaves this out: load distribution along "
                              "the face and root stresses are better than those of the real stage. "
                              "errors.sun_planet_misalignment_um and errors.ring_planet_misalignment_um put a "
                              "misalignment into the contact solution",
                              tilt * set.sun_mesh().common_face().width / units::um)});
}

}  // namespace

std::vector<Warning> stage_scene_warnings(const Scene& scene, const GearGeometry& geometry) {
  std::vector<Warning> list;
  if (scene.dynamics && scene.stage.planets > 1)
    if (const auto keys = rigid_unasked(scene); !keys.empty())
      list.push_back({"supports_left_out", Severity::warning,
                      fmt::format("rigid, because the scene does not mention {}. Soft planet bearings, carriers and "
                                  "rings equalise the planet loads; give a stiffness, or \"rigid\"",
                                  fmt::join(keys, ", "))});
  warn_of_tilting_pins(list, scene, geometry);
  warn_of_coupling_left_out(list, scene);
  if (scene.dynamics) {
    const auto in_space = space_dynamics_warnings(scene, geometry);
    list.insert(list.end(), in_space.begin(), in_space.end());
  }
  warn_of_gauges(list, scene);
  std::vector<std::string> prescribed;
  if (sun_and_planets(scene).sun_planet.stiffness != StiffnessShape::computed) prescribed.emplace_back("sun mesh");
  if (planetary(scene).ring_planet.stiffness != StiffnessShape::computed) prescribed.emplace_back("ring mesh");
  warn_of_shares(list, scene, prescribed);
  const auto& e = planetary(scene).errors;
  if (planetary(scene).tolerances && !(e.sun_pitch.empty() && e.planet_pitch.empty() && e.ring_pitch.empty()))
    list.push_back({"pitch_deviations", Severity::warning,
                    "the assemblies of [tolerances] have teeth without pitch deviations: those of [errors] are in all "
                    "other results"});
  if (planetary(scene).tolerances && by_default(scene, "tolerances.distribution"))
    list.push_back({"distribution_assumed", Severity::note,
                    "deviations within the tolerances are drawn from a normal distribution, because the scene does not "
                    "mention tolerances.distribution. With \"uniform\" they are larger"});
  warn_of_clearance(list, geometry.sun_mesh(), {"planet", "sun"}, "sun mesh");
  warn_of_measured_flanks(list, geometry.sun_mesh(), {"planet", "sun"}, "sun mesh");
  warn_of_undercut(list, geometry.sun_mesh().wheel(), "sun");
  warn_of_undercut(list, geometry.sun_mesh().pinion(), "planet");
  for (const auto& ring : geometry.rings) {
    const auto mesh = "ring mesh of '" + ring.name + "'";
    warn_of_clearance(list, ring.set.ring_mesh(), {"planet", "ring"}, mesh);
    warn_of_measured_flanks(list, ring.set.ring_mesh(), {"planet", "ring"}, mesh);
  }
  if (scene.dynamics) {
    warn_of_backlash(list, sun_and_planets(scene).sun_planet.half_backlash.value_or(scene.dynamics->half_backlash),
                     geometry.sun_mesh(), "sun mesh");
    warn_of_backlash(list, planetary(scene).ring_planet.half_backlash.value_or(scene.dynamics->half_backlash),
                     geometry.rings.front().set.ring_mesh(), "ring mesh");
  }
  return list;
}

std::vector<Warning> stage_warnings(const dynamics::DynamicResponse& response, const std::string& ring) {
  std::vector<Warning> list;
  for (const auto& [mesh, kind] : {std::pair{"sun mesh", &response.sun_planet}, {"ring mesh", &response.ring_planet}})
    if (auto warning = back_flanks(mesh, kind->branches); !warning.empty())
      list.push_back({"back_flanks", Severity::warning, std::move(warning), ring});
  return list;
}

}  // namespace annulus::app
