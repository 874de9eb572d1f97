#include "geometry/power_flow.h"

#include "core/errors.h"

namespace annulus::geometry {

MemberValues tooth_weights(int sun_teeth, int ring_teeth) {
  const double sun = sun_teeth, ring = ring_teeth;
  return {sun, -(sun + ring), ring};
}

MemberValues member_speeds(int sun_teeth, int ring_teeth, KnownSpeed first, KnownSpeed second) {
  if (first.member == second.member) throw GeometryError("the speeds of two different members are needed");
  const auto weight = tooth_weights(sun_teeth, ring_teeth);
  MemberValues speeds;
  speeds[first.member] = first.speed;
  speeds[second.member] = second.speed;
  for (const auto third : stage_members)
    if (third != first.member && third != second.member)
      speeds[third] = -(weight[first.member] * first.speed + weight[second.member] * second.speed) / weight[third];
  return speeds;
}

MemberValues member_torques(int sun_teeth, int ring_teeth, StageMember member, double torque) {
  const auto weight = tooth_weights(sun_teeth, ring_teeth);
  const double unit = torque / weight[member];
  return {weight[StageMember::sun] * unit, weight[StageMember::carrier] * unit, weight[StageMember::ring] * unit};
}

}  // namespace annulus::geometry
