#include "app/systems/planetary/operating_point.h"

#include <cmath>
#include <numbers>

#include "app/systems/planetary/planetary_input.h"
#include "core/errors.h"

namespace annulus::app {

using geometry::StageMember;

geometry::MemberValues stage_speeds(const PlanetaryStageInput& stage, int sun_teeth, int ring_teeth) {
  std::vector<geometry::KnownSpeed> known;
  if (stage.held) known.push_back({*stage.held, 0});
  for (const auto& [member, speed] : {std::pair{StageMember::sun, stage.sun_speed},
                                      {StageMember::carrier, stage.carrier_speed},
                                      {StageMember::ring, stage.ring_speed}})
    if (speed) known.push_back({member, *speed});
  require(known.size() == 2, "a planetary stage has two known speeds");
  return geometry::member_speeds(sun_teeth, ring_teeth, known.front(), known.back());
}

OperatingPoint operating_point(const PlanetaryStageInput& stage, int planets, int sun_teeth, int ring_teeth,
                               double sun_base_radius) {
  OperatingPoint point;
  point.driver = stage.drives;
  auto& flow = point.flow;
  flow.speed = stage_speeds(stage, sun_teeth, ring_teeth);
  // The torque of the driver acts in its direction; the given one determines the size of all.
  const double drive = flow.speed[point.driver];
  flow.torque = geometry::member_torques(sun_teeth, ring_teeth, point.driver,
                                         std::copysign(stage.power ? *stage.power / std::abs(drive) : 1.0, drive));
  for (const auto& [member, torque] : {std::pair{StageMember::sun, stage.sun_torque},
                                       {StageMember::carrier, stage.carrier_torque},
                                       {StageMember::ring, stage.ring_torque}})
    if (torque)
      flow.torque =
          geometry::member_torques(sun_teeth, ring_teeth, member, std::copysign(*torque, flow.torque[member]));
  point.mirrored = flow.torque[StageMember::sun] < 0;
  point.power = flow.power(point.driver);
  point.sun_torque = std::abs(flow.torque[StageMember::sun]);
  point.mesh_frequency =
      ring_teeth * std::abs(flow.speed[StageMember::carrier] - flow.speed[StageMember::ring]) / (2 * std::numbers::pi);
  point.mean_mesh_force = point.sun_torque / (planets * sun_base_radius);
  return point;
}

}  // namespace annulus::app
