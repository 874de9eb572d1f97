#include "dynamics/systems/planetary/planetary_stage.h"
#include "geometry/planetary.h"

namespace annulus::dynamics {

void set_kinematics(PlanetaryStage& stage, const geometry::PlanetarySet& set) {
  stage.sun_teeth = set.sun().teeth();
  stage.planet_teeth = set.planet().teeth();
  stage.ring_teeth = set.ring().teeth();
  stage.sun.radius = set.sun().base_radius();
  stage.planet.radius = set.planet().base_radius();
  stage.ring.radius = set.ring().base_radius();
  stage.carrier.radius = set.centre_distance();
  stage.sun_working_angle = set.sun_mesh().working_pressure_angle();
  stage.ring_working_angle = set.ring_mesh().working_pressure_angle();
  stage.planet_angles.clear();
  stage.sun_phase_lag.clear();
  stage.ring_phase_lag.clear();
  stage.ring_tooth_offset.clear();
  for (int n = 0; n < set.planets(); ++n) {
    stage.planet_angles.push_back(set.planet_angle(n));
    stage.sun_phase_lag.push_back(set.sun_phase_lag(n));
    stage.ring_phase_lag.push_back(set.ring_phase_lag(n));
    stage.ring_tooth_offset.push_back(set.ring_tooth_offset(n));
  }
}

}  // namespace annulus::dynamics
