#include "dynamics/systems/planetary/space_motion.h"

#include "dynamics/systems/planetary/stage_forms.h"

namespace annulus::dynamics {

SpaceMotion space_motion(const PlanetaryStage& stage, const TimeSeries& series) {
  return stage.space ? space_motion(stage, assemble(stage), series) : SpaceMotion{};
}

SpaceMotion space_motion(const PlanetaryStage& stage, const LumpedSystem& lumped, const TimeSeries& series) {
  if (!stage.space) return {};
  LumpedSystemBuilder builder;
  const auto forms = add_bodies_in_space(builder, stage);
  SpaceSystem system;
  for (const auto& bearing : stage.space->bearings) system.bearings.push_back(bearing_motion(stage, forms, bearing));
  system.turned = forms.ring.u;
  system.turned_radius = stage.ring.radius;
  system.carrier_speed = stage.carrier_speed;
  const auto planets = static_cast<std::size_t>(stage.planets());
  system.faces.assign(planets, &stage.space->sun_face);
  system.faces.resize(2 * planets, &stage.space->ring_face);
  return motion_in_space(*stage.space, system, lumped, series);
}

}  // namespace annulus::dynamics
