#include "fem/placed_field.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "geometry/gear_places.h"

namespace annulus::fem {

namespace {

/// rad, of tooth 0 from the line of centres.
double angle_of(geometry::GearRole body, const LoadedPosition& position, const geometry::GearPair& pair) {
  // The pitch point lies on the line of centres.
  if (body == geometry::GearRole::wheel) return -position.ring_angle;
  // With its leading flank a driver turns counter-clockwise; the pinion drives a ring with its trailing flank.
  const bool counter_clockwise = !pair.internal() && pair.driver() == geometry::GearRole::pinion;
  return geometry::pair_places(pair).pinion +
         (counter_clockwise ? 1 : -1) * position.mesh_phase * pair.pinion().pitch_angle();
}

}  // namespace

BodyField in_frame_of_pair(const BodyField& field, const LoadedPosition& position, const geometry::GearPair& pair) {
  const bool pinion = field.body == geometry::GearRole::pinion;
  const double deflection = position.entry.lte - position.entry.unloaded_te;
  const double rotation = pinion ? (pair.internal() ? -1 : 1) * deflection / pair.pinion().base_radius() : 0;
  const Eigen::Vector3d axis = (pinion ? pair.centre_distance() : 0) * Eigen::Vector3d::UnitX();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle_of(field.body, position, pair), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  BodyField placed = field;
  for (std::size_t v = 0; v < placed.mesh.vertices.size(); ++v) {
    const Eigen::Vector3d own = turn * field.mesh.vertices[v];
    placed.mesh.vertices[v] = axis + own;
    placed.displacement[v] = turn * field.displacement[v] + rotation * Eigen::Vector3d::UnitZ().cross(own);
    const auto& s = field.stress[v];
    Eigen::Matrix3d tensor;
    tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    tensor = (turn * tensor * turn.transpose()).eval();
    placed.stress[v] = {tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(1, 2), tensor(2, 0)};
  }
  return placed;
}

double visible_exaggeration(double size, double largest_displacement) {
  constexpr double share = 0.02, least = 1e-12;  // of the size: without load nothing is moved
  return share * size / std::max(largest_displacement, least * size);
}

}  // namespace annulus::fem
