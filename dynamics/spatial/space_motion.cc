#include "dynamics/spatial/space_motion.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

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

/// The same of all coordinates of a coupling.
Eigen::MatrixXd course(const LinearCoupling& coupling, const SpaceSystem& system, const TimeSeries& series) {
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(coupling.stiffness.rows(), series.time.size());
  Eigen::Index first = 0;
  for (const std::size_t i : coupling.bearings) {
    motions.middleRows<5>(first) = course(system.bearings[i], series);
    first += 5;
  }
  if (coupling.turned)
    for (const auto& [dof, factor] : system.turned) motions.row(first) += factor * series.displacement.row(dof);
  return motions;
}

/// Force on the body by its stiffness and preload alone. `angle`: of the carrier, rad.
Eigen::MatrixXd linear_force(const LinearBearing& bearing, const Eigen::MatrixXd& motion, const Eigen::ArrayXd& angle) {
  Eigen::MatrixXd force = -bearing.stiffness * motion;
  force.colwise() -= bearing.preload;
  if (bearing.standing.any())
    force -= bearing.standing * angle.cos().matrix().transpose() +
             quarter_turn_later(bearing.standing) * angle.sin().matrix().transpose();
  return force;
}

/// Of forces (N) and moments, these over a lever (m), over all times.
double largest_force(Eigen::MatrixXd force, double lever) {
  force.bottomRows<2>() /= lever;
  return force.colwise().norm().maxCoeff();
}

/// Forces of couplings on their bearings, 5 x times each; empty for bearings without.
struct CouplingForces {
  std::vector<Eigen::MatrixXd> from_others;  ///< from the motions of others, by the stiffness
  std::vector<Eigen::MatrixXd> by_law;       ///< all of them
};

/// N, at the end of the table of a bearing; 0: it has none.
double end_of_table(const SpaceSupports& supports, const LinearBearing& bearing) {
  const auto end = [](const StageBearing& law) { return law.force.empty() ? 0.0 : law.force.back(); };
  if (bearing.law) return end(*bearing.law);
  for (const auto& coupling : supports.couplings) {
    if (!coupling.law) continue;
    for (const auto& seated : coupling.law->bearings)
      if (seated.bearing.name == bearing.name && seated.bearing.body == bearing.body) return end(seated.bearing);
  }
  return 0;
}

}  // namespace

SpaceMotion motion_in_space(const SpaceSupports& supports, const SpaceSystem& system, const LumpedSystem& lumped,
                            const TimeSeries& series) {
  SpaceMotion result;
  const Eigen::Index times = series.time.size(), meshes = std::ssize(system.faces);
  require(series.force.rows() >= 2 * meshes, fmt::format("{} forces of {} meshes", series.force.rows(), meshes));
  const Eigen::ArrayXd angle = system.carrier_speed * series.time.array();
  const double mean_force = series.force.topRows(meshes).cwiseAbs().mean(), lever = system.faces.front()->width / 2;
  const bool whole = supports.laws == BearingLaws::whole;
  CouplingForces coupled{std::vector<Eigen::MatrixXd>(supports.bearings.size()),
                         std::vector<Eigen::MatrixXd>(supports.bearings.size())};
  for (const auto& coupling : supports.couplings) {
    const auto motions = course(coupling, system, series);
    const Eigen::MatrixXd forces = -coupling.stiffness * motions;
    const Eigen::MatrixXd by_law = coupling.law ? forces_by_law(coupling, motions) : Eigen::MatrixXd();
    Eigen::Index first = 0;
    for (const std::size_t i : coupling.bearings) {
      coupled.from_others[i] = forces.middleRows<5>(first);
      if (coupling.law) coupled.by_law[i] = by_law.middleRows<5>(first);
      first += 5;
    }
    if (!coupling.turned) continue;
    Eigen::VectorXd force = forces.row(first).transpose().array() - coupling.turning_preload;
    if (coupling.law && whole) force = by_law.row(first).transpose();
    result.turning_torque = system.turned_radius * force;
  }
  for (std::size_t i = 0; i < supports.bearings.size(); ++i) {
    const auto& b = supports.bearings[i];
    const bool by_coupling = coupled.by_law[i].size() > 0, nonlinear = b.law || by_coupling;
    if (b.stiffness.isZero(0) && !nonlinear) continue;  // all that it does is rigid
    const auto motion = course(system.bearings[i], series);
    SpaceMotion::Bearing bearing{b.element(), b.body, b.on, linear_force(b, motion, angle)};
    bearing.table_end = end_of_table(supports, b);
    if (coupled.from_others[i].size() > 0) bearing.force += coupled.from_others[i];
    if (nonlinear) {
      Eigen::MatrixXd by_law =
          by_coupling
              ? coupled.by_law[i]
              : Eigen::MatrixXd(linear_force(beside_law(supports, i), motion, angle) + beyond_stiffness(b, motion));
      if (whole)
        bearing.force = std::move(by_law);
      else
        bearing.law_deviation = largest_force(by_law - bearing.force, lever) / mean_force;
    }
    for (Eigen::Index k = 0; k < 5; ++k)
      if (b.rigid.at(static_cast<std::size_t>(k))) bearing.force.row(k).setConstant(not_known);
    result.bearings.push_back(std::move(bearing));
  }
  for (Eigen::Index m = 0; m < meshes; ++m) {
    const auto& face = *system.faces[static_cast<std::size_t>(m)];
    const auto& element = lumped.meshes()[static_cast<std::size_t>(m)];
    const auto force = series.force.row(m), tilt = series.force.row(meshes + m);
    SpaceMotion::Mesh mesh{.name = series.meshes[static_cast<std::size_t>(m)],
                           .face_width = face.width,
                           .solid_face = face.shape != nullptr,
                           .mean_place = not_known,
                           .cycles = element.frequency * series.time.array() + element.phase_offset,
                           .force = force.transpose(),
                           .tilt = series.displacement.transpose() * lumped.mesh_vector(meshes + m),
                           .place = Eigen::VectorXd(times)};
    const double size = force.cwiseAbs().mean();
    if (size > 0) mesh.mean_place = face.width / 2 * tilt.sum() / force.sum();
    for (Eigen::Index t = 0; t < times; ++t)
      mesh.place[t] = std::abs(force[t]) <= SpaceMotion::light * size ? not_known : face.width / 2 * tilt[t] / force[t];
    result.meshes.push_back(std::move(mesh));
  }
  return result;
}

}  // namespace annulus::dynamics
