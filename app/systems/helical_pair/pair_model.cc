#include "app/systems/helical_pair/pair_model.h"

#include <cmath>
#include <numbers>

#include "app/model/excitation.h"
#include "app/model/stiff_supports.h"
#include "app/plan/gear_geometry.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/pair_space.h"
#include "app/systems/shared/rotors.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

geometry::Gear pair_gear(const Scene& scene, const PairGearInput& input, const char* name, int hand) {
  return geometry_of(name, [&] { return make_gear(scene, input, geometry::GearKind::external, hand); });
}

dynamics::PairGear lumped_gear(const Scene& scene, const PairGearInput& input, const geometry::Gear& gear, double error,
                               double phase) {
  dynamics::PairGear result;
  result.teeth = input.teeth;
  result.mass = *input.mass;
  result.inertia = *pair_inertia(scene, input);
  result.radius = gear.base_radius();
  result.bearing_transverse = input.bearing_transverse;
  result.bearing_axial = input.bearing_axial;
  result.error = {error, phase};
  return result;
}

/// Hz
double mesh_frequency(const Scene& scene) {
  return helical_pair(scene).pinion.teeth * helical_pair(scene).stage.pinion_speed / (2 * std::numbers::pi);
}

}  // namespace

double PairGeometry::to_normal() const { return 1 / std::pow(std::cos(base_helix_angle), 2); }

double pair_centre_distance(const Scene& scene) {
  const auto& stage = scene.stage;
  if (stage.centre_distance > 0) return stage.centre_distance;
  const auto gear = pair_gear(scene, helical_pair(scene).pinion, "pinion", 1);
  const int teeth = helical_pair(scene).pinion.teeth + helical_pair(scene).wheel.teeth;
  const double shift = helical_pair(scene).pinion.profile_shift + helical_pair(scene).wheel.profile_shift,
               at = gear.transverse_pressure_angle();
  // inv(working angle) [ISO21771].
  const double inv = geometry::involute(at) + 2 * std::tan(stage.pressure_angle) * shift / teeth;
  if (inv < 0)
    throw GeometryError("pinion, wheel: the profile shifts leave no working pressure angle; make them larger");
  // Without shifts nothing need be inverted.
  const double working = shift == 0 ? at : geometry::inverse_involute(inv);
  return gear.transverse_module() * teeth / 2 * std::cos(at) / std::cos(working);
}

std::optional<double> pair_inertia(const Scene& scene, const PairGearInput& gear) {
  if (gear.inertia || !gear.mass) return gear.inertia;
  const double radius = scene.stage.module * gear.teeth / (2 * std::cos(scene.stage.helix_angle));
  return *gear.mass * radius * radius / 2;
}

PairGeometry make_pair_geometry(const Scene& scene) {
  const auto pinion = pair_gear(scene, helical_pair(scene).pinion, "pinion", 1);
  const auto wheel = pair_gear(scene, helical_pair(scene).wheel, "wheel", -1);
  const double distance = pair_centre_distance(scene);
  return {.gears = geometry_of("pinion and wheel",
                               [&] { return geometry::GearPair(pinion, wheel, distance, geometry::GearRole::pinion); }),
          .base_helix_angle = std::abs(pinion.base_helix_angle()),
          .transverse_force = std::abs(helical_pair(scene).stage.pinion_torque) / pinion.base_radius()};
}

RollingMesh rolling_mesh(const Scene& scene, const PairGeometry& geometry) {
  return {&geometry.gears, mesh_frequency(scene), geometry.transverse_force};
}

dynamics::HelicalPair make_pair(const Scene& scene, const PairGeometry& geometry, const dynamics::MeshExcitation& mesh,
                                double mesh_error, const PairFlanks& flanks) {
  if (!scene.dynamics) throw InternalError("internal error: dynamics of a scene without [dynamics]");
  const auto& d = *scene.dynamics;
  const auto& e = helical_pair(scene).errors;
  dynamics::HelicalPair pair;
  pair.pinion = lumped_gear(scene, helical_pair(scene).pinion, geometry.pinion(), e.pinion_error, e.pinion_error_phase);
  pair.wheel = lumped_gear(scene, helical_pair(scene).wheel, geometry.wheel(), e.wheel_error, e.wheel_error_phase);
  const double stiffness = dynamics::mean_stiffness(mesh);
  for (auto* gear : {&pair.pinion, &pair.wheel})
    for (auto* bearing : {&gear->bearing_transverse, &gear->bearing_axial})
      *bearing = rigid_if_stiff(*bearing, stiffness, scene.accuracy);
  // The other hand turns only the sign of the axial motions.
  pair.base_helix_angle = std::copysign(geometry.base_helix_angle, scene.stage.helix_angle);
  pair.working_angle = geometry.gears.working_pressure_angle();
  pair.mesh = mesh;
  pair.mesh_error = {mesh_error, e.mesh_error_phase};
  pair.half_backlash = helical_pair(scene).pinion_wheel.half_backlash.value_or(d.half_backlash);
  pair.mesh_damping_ratio = helical_pair(scene).pinion_wheel.damping_ratio.value_or(d.mesh_damping_ratio);
  pair.bearing_damping_ratio = d.support_damping_ratio;
  pair.pinion.damping_ratio = helical_pair(scene).pinion.damping_ratio;
  pair.wheel.damping_ratio = helical_pair(scene).wheel.damping_ratio;
  pair.structural_damping = structural_damping(d);
  pair.damping_without_contact = d.mesh_damping == MeshDamping::always;
  pair.friction = flank_friction(scene, rolling_mesh(scene, geometry), flanks.shares, MeshForces::normal);
  pair.film = squeeze_film(scene, geometry.gears, MeshForces::normal);
  pair.pinion_speed = helical_pair(scene).stage.pinion_speed;
  pair.pinion_torque = helical_pair(scene).stage.pinion_torque;
  pair.rotors = rotors_of(scene);
  if (pair_in_space(scene)) put_in_space(pair, scene, geometry, flanks.face);
  return pair;
}

dynamics::SimulationOptions pair_simulation(const Scene& scene) {
  return given_simulation(*scene.dynamics, mesh_frequency(scene));
}

}  // namespace annulus::app
