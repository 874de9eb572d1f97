#pragma once

#include <Eigen/Core>

#include "dynamics/steady_state/steady_response.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// Forces of the planets on their pins, N, planets x times: radial outwards and tangential in the sense of rotation, in
/// the frame of the carrier. The mean tangential force is T_c / (N a).
struct BearingForces {
  Eigen::MatrixXd radial, tangential;
  [[nodiscard]] Eigen::MatrixXd resultant() const {
    return (radial.array().square() + tangential.array().square()).sqrt().matrix();
  }
};

/// Elastic bearings: force of springs (or of the law of a bearing with play) and dampers, k X + c X'. Rigid bearings:
/// from the equilibrium of the planet. The centrifugal force m a Omega^2 is part of the radial force, unless the stage
/// neglects the rotating frame. `series` must belong to the stage.
[[nodiscard]] BearingForces bearing_forces(const PlanetaryStage& stage, const TimeSeries& series);

/// Reaction of the supports of a central body on the housing, one value per time: k x + c (x' - Omega y) and so on. For
/// rigid supports it is the sum of the forces of the meshes (of the planets, for the carrier) on the body; in space, of
/// its bearings on the housing without their dampers.
struct SupportReaction {
  Eigen::VectorXd x, y;    ///< N, in the frame of the carrier
  Eigen::VectorXd torque;  ///< N m
  [[nodiscard]] Eigen::VectorXd magnitude() const { return (x.array().square() + y.array().square()).sqrt().matrix(); }
};
[[nodiscard]] SupportReaction support_reaction(const PlanetaryStage& stage, const TimeSeries& series,
                                               geometry::StageMember member);

struct StageForces {
  BearingForces pins;
  SupportReaction sun, ring, carrier;
};
/// All of them. `system`: assemble(stage).
[[nodiscard]] StageForces stage_forces(const PlanetaryStage& stage, const LumpedSystem& system,
                                       const TimeSeries& series);

}  // namespace annulus::dynamics
