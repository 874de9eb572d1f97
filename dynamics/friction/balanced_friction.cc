#include "dynamics/friction/balanced_friction.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <utility>

#include "core/errors.h"
#include "dynamics/modes/modes.h"
#include "dynamics/steady_state/frequency_response.h"

namespace annulus::dynamics {

namespace {

/// Where the torque of a body acts, and the power that it brings by the speed of the body.
struct TorquePlace {
  int dof = 0;
  double force = 0, power = 0;  ///< N, W
};

std::vector<TorquePlace> torque_places(const LumpedSystem& system, const std::vector<Rotor>& rotors,
                                       const std::vector<ShaftEnd>& ends) {
  std::vector<TorquePlace> places;
  for (const auto& end : ends) {
    if (end.load == 0 || !end.refusal.empty()) continue;
    const auto behind = rotors_of(rotors, end.name);
    const int dof = system.find((behind.empty() ? end.name : rotors[behind.back()].name) + "_u");
    if (dof >= 0) places.push_back({dof, end.load, end.load * end.radius * end.speed});
  }
  return places;
}

/// Mean friction of the meshes under constant loads, with stiffnesses that do not change.
class MeanFriction {
 public:
  explicit MeanFriction(const LumpedSystem& system)
      : stiffness_(mean_stiffnesses(system)),
        linear_(system, stiffness_),
        friction_(Eigen::MatrixXd::Zero(system.dofs(), stiffness_.size())) {
    for (Eigen::Index m = 0; m < stiffness_.size(); ++m)
      for (const auto& share : system.meshes()[static_cast<std::size_t>(m)].friction)
        for (const auto& [i, factor] : share.along) friction_(i, m) += factor * share.curve.mean();
  }

  /// N, one per DOF.
  [[nodiscard]] Eigen::VectorXd under(const Eigen::VectorXd& load) const {
    const Eigen::VectorXd approach = linear_.mesh_vectors().transpose() * linear_.static_displacement(load);
    return -friction_ * stiffness_.cwiseProduct(approach).cwiseAbs();
  }

 private:
  Eigen::VectorXd stiffness_;
  FrequencyResponse linear_;
  Eigen::MatrixXd friction_;
};

}  // namespace

LumpedSystem with_balanced_friction(const LumpedSystem& system, const std::vector<Rotor>& rotors,
                                    const std::vector<ShaftEnd>& ends) {
  if (!system.has_friction()) return system;
  const auto found = modes(system);
  const Eigen::MatrixXd b = system.mesh_vectors();
  const Eigen::Index free =
      neutral_motions(found,
                      system.stiffness() + system.rotating_stiffness() +
                          b * mesh_stiffness_matrix(system, mean_tangents(system)) * b.transpose(),
                      system.mass());
  if (free == 0) return system;
  const Eigen::MatrixXd neutral = found.shapes().leftCols(free), momentum = system.mass() * neutral;

  const MeanFriction mean(system);
  LumpedSystemBuilder builder;
  builder.add(system);
  builder.keep_friction_from(neutral);
  const auto places = torque_places(system, rotors, ends);
  if (places.empty()) return builder.build();
  // A single free rotation turns the way in which friction brakes it.
  const double sense = neutral.col(0).dot(mean.under(system.load())) < 0 ? 1 : -1;
  const auto power = [&](const TorquePlace& place) {
    return free == 1 ? place.force * sense * neutral(place.dof, 0) : place.power;
  };
  const auto strongest = std::max_element(
      places.begin(), places.end(), [&](const auto& one, const auto& other) { return power(one) < power(other); });
  std::vector<TorquePlace> changed;
  for (auto place = places.begin(); place != places.end(); ++place)
    if (free == 1 ? power(*place) < 0 : place != strongest) changed.push_back(*place);
  if (std::ssize(changed) < free)
    throw InputError(fmt::format("friction brakes {} free rotations; {} torques of driven bodies can balance it", free,
                                 changed.size()));
  Eigen::MatrixXd torque = Eigen::MatrixXd::Zero(system.dofs(), std::ssize(changed));
  for (std::size_t i = 0; i < changed.size(); ++i)
    torque(changed[i].dof, static_cast<Eigen::Index>(i)) = changed[i].force;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> balance(neutral.transpose() * torque);

  Eigen::VectorXd load = system.load(), losses;
  constexpr int steps = 8;  // each leaves a few coefficients of friction of the change before
  for (int i = 0; i < steps; ++i) {
    const Eigen::VectorXd friction = mean.under(load);
    losses = torque * balance.solve(-neutral.transpose() * friction);
    losses -= momentum * (neutral.transpose() * losses);
    load = system.load() + losses + friction - momentum * (neutral.transpose() * friction);
  }
  for (Eigen::Index i = 0; i < losses.size(); ++i)
    builder.add_load({{static_cast<int>(i), 1.0}}, losses[i], LoadCause::losses);
  return builder.build();
}

}  // namespace annulus::dynamics
