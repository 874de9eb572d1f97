#include "dynamics/systems/planetary/space_motion.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"
#include "core/not_known.h"
#include "dynamics/systems/planetary/stage_forms.h"

namespace annulus::dynamics {

SpaceMotion space_motion(const PlanetaryStage& stage, const TimeSeries& series) {
  SpaceMotion result;
  if (!stage.space) return result;
  LumpedSystemBuilder builder;
  const auto forms = add_bodies_in_space(builder, stage);
  const Eigen::Index times = series.time.size(), meshes = 2 * static_cast<Eigen::Index>(stage.planets());
  require(series.force.rows() == 2 * meshes, fmt::format("{} forces of {} meshes", series.force.rows(), meshes));
  const Eigen::ArrayXd angle = stage.carrier_speed * series.time.array();
  for (const auto& b : stage.space->bearings) {
    if (b.stiffness.isZero(0)) continue;  // all that it does is rigid
    const auto d = relative_motion(stage, forms, b.body, b.on);
    Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(5, times);
    for (Eigen::Index i = 0; i < 5; ++i)
      for (const auto& [dof, factor] : d[static_cast<std::size_t>(i)])
        motion.row(i) += factor * series.displacement.row(dof);
    SpaceMotion::Bearing bearing{b.element(), b.body, b.on, -b.stiffness * (to_place(b.place) * motion)};
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
