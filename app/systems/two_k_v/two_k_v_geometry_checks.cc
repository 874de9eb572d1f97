#include "app/systems/two_k_v/two_k_v_geometry_checks.h"

#include <cmath>

#include "app/scene/bore_checks.h"
#include "app/scene/small_displacements.h"
#include "app/systems/two_k_v/two_k_v_model.h"

namespace annulus::app {

void check_rims(const Scene& scene, const geometry::GearPair& pair) {
  if (scene.sun_planet.stiffness != StiffnessShape::computed && scene.sun_planet.compare != Compare::computed) return;
  check_bore(scene, "sun", scene.sun, pair.wheel());
  check_bore(scene, "planet", scene.planet, pair.planet());
}

void check_two_k_v_displacements(const Scene& scene) {
  constexpr const char* load = "output.torque_Nm";
  const auto stage = two_k_v_kinematics(scene);
  if (scene.dynamics) {
    const double crank = std::abs(scene.output.torque) / (stage.cranks * stage.crank_circle_radius());
    check_prescribed_mesh(scene, load, scene.sun_planet, std::abs(stage.mean_sun_mesh_force()));
    check_prescribed_mesh(scene, load, scene.arc_pins, std::abs(stage.mean_arc_mesh_force()));
    check_bearing(scene, "crank.bearing_N_per_m", *scene.crank.bearing, crank);
    check_bearing(scene, "arc_gear.bearing_N_per_m", *scene.arc_gear.bearing, std::abs(stage.mean_arc_mesh_force()));
  }
  if (has_elastic_bodies(scene.sun_planet) || scene.sun_planet.compare == Compare::computed)
    check_load(scene, load, stage.mean_sun_mesh_force());
}

}  // namespace annulus::app
