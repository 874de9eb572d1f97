#pragma once

#include <Eigen/Core>

#include "dynamics/systems/planetary/planetary_stage.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::dynamics {

/// Forces of the planets on their pins, N, one row per planet, one column per time; radial outwards and tangential in
/// the sense of rotation, in the frame of the carrier. The mean tangential force is T_c / (N a).
struct BearingForces {
  Eigen::MatrixXd radial, tangential;
  [[nodiscard]] Eigen::MatrixXd resultant() const {
    return (radial.array().square() + tangential.array().square()).sqrt().matrix();
  }
};

/// From springs and dampers of the bearings, k X + c X'; of rigid bearings from the equilibrium of the planet. The
/// centrifugal force m a Omega^2 is part of the radial force (unless the stage leaves out the rotating frame).
[[nodiscard]] BearingForces bearing_forces(const PlanetaryStage& stage, const TimeSeries& series);

enum class CentralMember { sun, ring, carrier };

/// What a central body puts on the housing through its supports, one value per time: k x + c (x' - Omega y) and so on,
/// of rigid supports the sum of what the meshes (the planets, for the carrier) put on the body.
struct SupportReaction {
  Eigen::VectorXd x, y;    ///< N, in the frame of the carrier
  Eigen::VectorXd torque;  ///< N m
  [[nodiscard]] Eigen::VectorXd magnitude() const { return (x.array().square() + y.array().square()).sqrt().matrix(); }
};
[[nodiscard]] SupportReaction support_reaction(const PlanetaryStage& stage, const TimeSeries& series,
                                               CentralMember member);

}  // namespace annulus::dynamics
