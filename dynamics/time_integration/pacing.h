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
/// function of the nominal time, whose rate over the time is the pace s, the factor of the speed: at a standstill it
/// stands still, and backwards it runs back. With the acceleration a = ds/dt the system is
///
///   M q'' + (C + s G) q' + (K + s^2 K_sym + s K_skew) q + sum b F = T f_T + s^2 f_R + |T| r f_L + f - a M v_0 + a D
///
/// with the rates of errors and mesh vectors times s. K_sym and K_skew are the parts of K_Omega (centripetal terms;
/// dampers to the housing), f_T the load from torques, f_R that from rotation. Friction and what balances it (f_L) act
/// in the sense r of the rotation, 1 or -1; below `slipping` r is in proportion to the speed. v_0 are the velocities of
/// the bodies in their nominal rotation, and D the torques that turn the inertias faster, in proportion to those that
/// drive, or to those of the load. The forces of Euler on the vibration itself are left out: they are to its elastic
/// forces as the angular acceleration to the square of its natural frequency.
class Pacing {
 public:
  /// `turning`: m/s, what the one free rotation of the system has at DOF `dof` in its nominal speed. Where the speed
  /// changes, throws InputError for a system that does not turn freely, or in more than one way, or that has no torque
  /// of the kind that accelerates it.
  Pacing(const LumpedSystem& system, Course course, const std::string& dof, double turning, AcceleratedBy by);

  static constexpr double slipping = 0.01;  ///< of the speed

  struct Now {
    double nominal = 0;  ///< s
    double speed = 1, torque = 1;
    double acceleration = 0;  ///< 1/s, of the speed factor
  };
  /// At a time, s; before 0 and behind the end nothing changes.
  [[nodiscard]] Now at(double time) const;
  /// Smallest amount of the factor of the speed between two times.
  [[nodiscard]] double least_speed(double from, double to) const;
  /// s: strictly after this time the next point of the course or jump of a stiffness, or infinity.
  [[nodiscard]] double next_stop(double time) const;
  /// Gives the workspace the rates of this place of the course.
  static void set_rates(const Now& now, LumpedSystem::Workspace& workspace);

  /// The right-hand side at this place from that of the system, which was found with its rates in the workspace.
  void correct(const Now& now, const double* y, double* dy) const;
  /// The same for its derivative, 2 DOFs x 2 DOFs.
  void correct(const Now& now, Eigen::Ref<Eigen::MatrixXd> jacobian) const;
  /// v_0, m/s, one per DOF; zero where the speed stays as it is.
  [[nodiscard]] const Eigen::VectorXd& rotation() const { return rotation_; }

 private:
  using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  [[nodiscard]] std::size_t piece_at(double time) const;
  const LumpedSystem* system_;
  int dofs_;
  Course course_;                // with a point at every standstill: the sense of rotation is one between two points
  std::vector<double> nominal_;  // s, of the points
  Eigen::VectorXd rotation_, of_torque_, of_losses_, of_rotation_, of_acceleration_;  // the latter M^-1 of the forces
  Sparse gyroscopic_, symmetric_, skew_;                                              // M^-1 of them
  mutable Eigen::VectorXd change_;
};

}  // namespace annulus::dynamics
