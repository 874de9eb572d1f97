#pragma once

#include <algorithm>

#include "app/systems/planetary/planetary_input.h"
#include "geometry/power_flow.h"

namespace annulus::app {

/// Speeds, torques and forces of a planetary stage that follow from its speeds, and from power or torque; SI.
struct OperatingPoint {
  geometry::PowerFlow flow;  ///< as the scene counts: counter-clockwise is positive
  geometry::StageMember driver = geometry::StageMember::sun;
  /// Whether the stage is computed as its mirror image: in that the torque of the sun is counter-clockwise.
  bool mirrored = false;
  double power = 0;            ///< W, of the driver; driving_power() of all bodies that drive
  double sun_torque = 0;       ///< N m, magnitude
  double mesh_frequency = 0;   ///< Hz
  double mean_mesh_force = 0;  ///< N, along the line of action, of each of the 2 N meshes

  [[nodiscard]] double driving_power() const {
    double sum = 0;
    for (const auto member : geometry::stage_members) sum += std::max(0.0, flow.power(member));
    return sum;
  }
  /// rad/s, in the stage as it is computed.
  [[nodiscard]] double computed_speed(geometry::StageMember member) const {
    return mirrored ? -flow.speed[member] : flow.speed[member];
  }
};

/// Speeds of all members, rad/s, from those that the scene has. Its speeds have been checked.
[[nodiscard]] geometry::MemberValues stage_speeds(const PlanetaryStageInput& stage, int sun_teeth, int ring_teeth);

/// Of a scene whose speeds and torques have been checked. `sun_base_radius` in m.
[[nodiscard]] OperatingPoint operating_point(const PlanetaryStageInput& stage, int planets, int sun_teeth,
                                             int ring_teeth, double sun_base_radius);

}  // namespace annulus::app
