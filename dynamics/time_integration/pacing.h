#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "dynamics/system/lumped_system.h"
#include "dynamics/time_integration/course.h"

namespace annulus::dynamics {

/// A system whose speed and torque follow a course.
///
/// Everything that repeats with the rotation (stiffnesses, errors, mesh vectors, loads that stand in the housing) is a
/// function of the nominal time, whose rate over the time is the pace s, the factor of the speed. Over the nominal
/// time, with u = dq/d(nominal time) and the acceleration a = ds/dt, the system is
///
///   s^2 M u' + a M u + (s C + s^2 G) u + (K + s^2 K_sym + s K_skew) q + sum b F = T f_T + s^2 f_R + f - a M v_0 + a D
///
/// with mesh dampers s c. K_sym and K_skew are the parts of K_Omega (centripetal terms; dampers to the housing), f_T
/// the load from torques, f_R that from rotation. v_0 are the velocities of the bodies in their nominal rotation, and D
/// the torques that turn the inertias faster, in proportion to those that drive, or to those of the load. The forces of
/// Euler on the vibration itself, smaller than those of Coriolis by the pace's change within a vibration, are left out.
class Pacing {
 public:
  /// `turning`: m/s, what the one free rotation of the system has at DOF `dof` in its nominal speed. Where the speed
  /// changes, throws InputError for a system that does not turn freely, or in more than one way, or that has no torque
  /// of the kind that accelerates it.
  Pacing(const LumpedSystem& system, Course course, const std::string& dof, double turning, AcceleratedBy by);

  [[nodiscard]] double nominal_end() const { return nominal_.back(); }  ///< s
  /// At a nominal time; before 0 and behind the end nothing changes.
  struct Now {
    double time = 0;  ///< s
    double speed = 1, torque = 1;
    double acceleration = 0;  ///< 1/s, of the speed factor
  };
  [[nodiscard]] Now at(double nominal) const;

  /// The right-hand side at a nominal time from that of the system, which was found with the pace in its workspace.
  void correct(double nominal, const double* y, double* dy) const;
  /// v_0, m/s, one per DOF; zero where the speed stays as it is.
  [[nodiscard]] const Eigen::VectorXd& rotation() const { return rotation_; }

 private:
  using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  int dofs_;
  Course course_;
  std::vector<double> nominal_;                                           // s, of the points
  Eigen::VectorXd rotation_, of_torque_, of_rotation_, of_acceleration_;  // the latter M^-1 of the forces
  Sparse damping_, gyroscopic_, symmetric_, skew_;                        // M^-1 of them
  mutable Eigen::VectorXd change_;
};

}  // namespace annulus::dynamics
