#include "app/systems/helical_pair/pair_geometry_checks.h"

#include <cmath>

#include "app/scene/bore_checks.h"
#include "app/scene/small_displacements.h"

namespace annulus::app {

void check_rims(const Scene& scene, const PairGeometry& geometry) {
  if (!has_elastic_bodies(scene.pinion_wheel)) return;
  check_bore(scene, "pinion", scene.pinion, geometry.pinion());
  check_bore(scene, "wheel", scene.wheel, geometry.wheel());
}

void check_displacements(const Scene& scene, const PairGeometry& geometry) {
  constexpr const char* load = "stage.pinion_torque_Nm";
  if (scene.dynamics) {
    check_error(scene, "errors.mesh_error_um", scene.errors.mesh_error.value_or(0));
    check_error(scene, "errors.pinion_error_um", scene.errors.pinion_error);
    check_error(scene, "errors.wheel_error_um", scene.errors.wheel_error);
    const double across = geometry.transverse_force, along = across * std::tan(std::abs(scene.stage.helix_angle));
    check_prescribed_mesh(scene, load, scene.pinion_wheel, across);
    check_bearing(scene, "pinion.bearing_transverse_N_per_m", scene.pinion.bearing_transverse, across);
    check_bearing(scene, "wheel.bearing_transverse_N_per_m", scene.wheel.bearing_transverse, across);
    check_bearing(scene, "pinion.bearing_axial_N_per_m", scene.pinion.bearing_axial, along);
    check_bearing(scene, "wheel.bearing_axial_N_per_m", scene.wheel.bearing_axial, along);
  }
  if (has_elastic_bodies(scene.pinion_wheel)) check_load(scene, load, geometry.transverse_force);
}

}  // namespace annulus::app
