#include "dynamics/systems/planetary/space_motion.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"
#include "core/not_known.h"
#include "dynamics/systems/planetary/stage_forms.h"

namespace annulus::dynamics {

namespace {

/// Coordinates of a body over time, 5 x times.
Eigen::MatrixXd course(const std::vector<LinearForm>& coordinates, const TimeSeries& series) {
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(5, series.time.size());
  for (Eigen::Index i = 0; i < 5; ++i)
    for (const auto& [dof, factor] : coordinates[static_cast<std::size_t>(i)])
      motion.row(i) += factor * series.displacement.row(dof);
  return motion;
}

}  // namespace

SpaceMotion space_motion(const PlanetaryStage& stage, const TimeSeries& series) {
  SpaceMotion result;
  if (!stage.space) return result;
  LumpedSystemBuilder builder;
  const auto forms = add_bodies_in_space(builder, stage);
  const Eigen::Index times = series.time.size(), meshes = 2 * static_cast<Eigen::Index>(stage.planets());
  require(series.force.rows() == 2 * meshes, fmt::format("{} forces of {} meshes", series.force.rows(), meshes));
  const Eigen::ArrayXd angle = stage.carrier_speed * series.time.array();
  // Forces on a planet from the motions of the others.
  Eigen::MatrixXd through_carrier;
  if (stage.space->between_planets.size() > 0) {
    Eigen::MatrixXd motions(5 * stage.planets(), times);
    for (int n = 0; n < stage.planets(); ++n)
      motions.middleRows<5>(static_cast<Eigen::Index>(5 * n)) =
          course(relative_motion(stage, forms, {StageBody::Kind::planet, n}, {StageBody::Kind::carrier}), series);
    through_carrier = -stage.space->between_planets * motions;
  }
  for (const auto& b : stage.space->bearings) {
    if (b.stiffness.isZero(0)) continue;  // all that it does is rigid
    const Eigen::MatrixXd motion = course(relative_motion(stage, forms, b.body, b.on), series);
    SpaceMotion::Bearing bearing{b.element(), b.body, b.on, -b.stiffness * (to_place(b.place) * motion)};
    if (through_carrier.size() > 0 && stands_on_carrier(b))
      bearing.force += through_carrier.middleRows<5>(5 * static_cast<Eigen::Index>(b.body.planet));
    bearing.force.colwise() -= b.preload;
    if (b.standing.any())
      bearing.force -= b.standing * angle.cos().matrix().transpose() +
                       quarter_turn_later(b.standing) * angle.sin().matrix().transpose();
    for (Eigen::Index i = 0; i < 5; ++i)
      if (b.rigid.at(static_cast<std::size_t>(i))) bearing.force.row(i).setConstant(not_known);
    result.bearings.push_back(std::move(bearing));
  }
  for (Eigen::Index m = 0; m < meshes; ++m) {
    const auto& face = m < meshes / 2 ? stage.space->sun_face : stage.space->ring_face;
    const auto force = series.force.row(m), tilt = series.force.row(meshes + m);
    SpaceMotion::Mesh mesh{series.meshes[static_cast<std::size_t>(m)], not_known, Eigen::VectorXd(times)};
    const double size = force.cwiseAbs().mean();
    if (size > 0) mesh.mean_place = face.width / 2 * tilt.sum() / force.sum();
    for (Eigen::Index t = 0; t < times; ++t)
      mesh.place[t] = std::abs(force[t]) <= SpaceMotion::light * size ? not_known : face.width / 2 * tilt[t] / force[t];
    result.meshes.push_back(std::move(mesh));
  }
  return result;
}

}  // namespace annulus::dynamics
