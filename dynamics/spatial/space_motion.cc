#include "dynamics/spatial/space_motion.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"
#include "core/not_known.h"
#include "dynamics/spatial/bearing_laws.h"

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

/// Largest difference of the law's force (N) to that of the tangents, with moments over a lever (m). `beyond`: of the
/// law, beyond K d.
double deviation(const LinearBearing& bearing, Eigen::MatrixXd beyond, const Eigen::ArrayXd& angle, double lever) {
  const auto rest = beside_law(bearing);
  beyond.colwise() += bearing.preload - rest.preload;
  const LinearBearing::Vector standing = bearing.standing - rest.standing;
  beyond +=
      standing * angle.cos().matrix().transpose() + quarter_turn_later(standing) * angle.sin().matrix().transpose();
  beyond.bottomRows<2>() /= lever;
  return beyond.colwise().norm().maxCoeff();
}

}  // namespace

SpaceMotion motion_in_space(const SpaceSupports& supports, const SpaceSystem& system, const TimeSeries& series) {
  SpaceMotion result;
  const Eigen::Index times = series.time.size(), meshes = std::ssize(system.faces);
  require(series.force.rows() >= 2 * meshes, fmt::format("{} forces of {} meshes", series.force.rows(), meshes));
  const Eigen::ArrayXd angle = system.carrier_speed * series.time.array();
  const double mean_force = series.force.topRows(meshes).cwiseAbs().mean(), lever = system.faces.front()->width / 2;
  // Forces on a bearing from the motions of others.
  std::vector<Eigen::MatrixXd> from_others(supports.bearings.size());
  for (const auto& coupling : supports.couplings) {
    Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(coupling.stiffness.rows(), times);
    Eigen::Index first = 0;
    for (const std::size_t i : coupling.bearings) {
      motions.middleRows<5>(first) = course(system.bearings[i], series);
      first += 5;
    }
    if (coupling.turned)
      for (const auto& [dof, factor] : system.turned) motions.row(first) += factor * series.displacement.row(dof);
    const Eigen::MatrixXd forces = -coupling.stiffness * motions;
    first = 0;
    for (const std::size_t i : coupling.bearings) {
      from_others[i] = forces.middleRows<5>(first);
      first += 5;
    }
    if (coupling.turned)
      result.turning_torque =
          system.turned_radius * (forces.row(first).transpose().array() - coupling.turning_preload).matrix();
  }
  for (std::size_t i = 0; i < supports.bearings.size(); ++i) {
    const bool whole = supports.laws == BearingLaws::whole;
    const auto b = whole ? beside_law(supports.bearings[i]) : supports.bearings[i];
    if (b.stiffness.isZero(0) && !b.law) continue;  // all that it does is rigid
    const Eigen::MatrixXd motion = course(system.bearings[i], series);
    SpaceMotion::Bearing bearing{b.element(), b.body, b.on, -b.stiffness * motion};
    if (from_others[i].size() > 0) bearing.force += from_others[i];
    bearing.force.colwise() -= b.preload;
    if (b.standing.any())
      bearing.force -= b.standing * angle.cos().matrix().transpose() +
                       quarter_turn_later(b.standing) * angle.sin().matrix().transpose();
    if (b.law) {
      const Eigen::MatrixXd beyond = beyond_stiffness(b, motion);
      if (whole)
        bearing.force += beyond;
      else
        bearing.law_deviation = deviation(b, beyond, angle, lever) / mean_force;
    }
    for (Eigen::Index k = 0; k < 5; ++k)
      if (b.rigid.at(static_cast<std::size_t>(k))) bearing.force.row(k).setConstant(not_known);
    result.bearings.push_back(std::move(bearing));
  }
  for (Eigen::Index m = 0; m < meshes; ++m) {
    const auto& face = *system.faces[static_cast<std::size_t>(m)];
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
