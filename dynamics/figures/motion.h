#pragma once

#include <Eigen/Core>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Deflections b^T q - e(t) of the meshes (m, meshes x times) at displacements (m, DOFs x times): their dynamic
/// transmission errors.
[[nodiscard]] Eigen::MatrixXd deflections(const LumpedSystem& system, const Eigen::VectorXd& time,
                                          const Eigen::MatrixXd& displacement);
/// q'' of the DOFs (m/s^2, DOFs x times) from the equations of motion; nothing is differenced.
[[nodiscard]] Eigen::MatrixXd accelerations(const LumpedSystem& system, const Eigen::VectorXd& time,
                                            const Eigen::MatrixXd& displacement, const Eigen::MatrixXd& velocity);

/// Root mean square about the mean and peak to peak of a motion, m.
struct MotionRange {
  double rms = 0, peak_to_peak = 0;
};
[[nodiscard]] MotionRange motion_range(const Eigen::Ref<const Eigen::RowVectorXd>& values);
/// The largest of both over the rows.
[[nodiscard]] MotionRange largest_range(const Eigen::Ref<const Eigen::MatrixXd>& rows);

/// A sampled curve reduced to each mesh cycle.
struct CycleValues {
  Eigen::VectorXd mean, smallest, largest;
};
/// `values` spans whole cycles.
[[nodiscard]] CycleValues over_cycles(const Eigen::Ref<const Eigen::VectorXd>& values, int cycles);

/// State of a mesh at the start of a mesh cycle.
struct PoincarePoint {
  double force = 0;       ///< N
  double deflection = 0;  ///< m
};

}  // namespace annulus::dynamics
