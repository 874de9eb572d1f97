#pragma once

#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// A system with all meshes in contact, between the jumps of its stiffnesses, as a linear one: z' = A z, with one A per
/// combination of the rectangular waves.
///
/// z = (elastic modal displacements, modal velocities / w, rigid displacements, 1, sin and cos of the error rates). The
/// modes are those of the mean stiffness about the equilibrium with it; w is the highest natural frequency. Entries are
/// then of similar size, and no large displacement (backlash) enters.
class PiecewiseSystem {
 public:
  /// Throws InputError when the load is not balanced.
  explicit PiecewiseSystem(const LumpedSystem& system);

  /// Do rigid motions stay free of force under rotation? Otherwise this state does not suffice.
  [[nodiscard]] bool neutral() const { return neutral_; }
  [[nodiscard]] double fastest() const { return w_; }  ///< rad/s
  /// Sizes of the part of the state that forces depend on, of the rigid displacements after it, and of the whole.
  [[nodiscard]] Eigen::Index inner() const { return elastic_ + dofs_; }
  [[nodiscard]] Eigen::Index rigid() const { return dofs_ - elastic_; }
  [[nodiscard]] Eigen::Index size() const {
    return inner() + rigid() + 1 + 2 * static_cast<Eigen::Index>(rates_.size());
  }
  [[nodiscard]] bool errors_turn() const { return !rates_.empty(); }

  /// Index of the combination of the waves at time t (s); a new one is appended.
  [[nodiscard]] int combination(double t);
  /// exp(A t) over a duration (s); stored for later calls.
  [[nodiscard]] const Eigen::MatrixXd& propagator(int combination, double duration);
  /// Linear maps from z to mesh forces (N), deflections beyond half backlash (m) and their rates (m/s).
  [[nodiscard]] const Eigen::MatrixXd& force(int combination) const { return combinations_[combination].force; }
  [[nodiscard]] const Eigen::MatrixXd& penetration() const { return penetration_; }
  [[nodiscard]] const Eigen::MatrixXd& penetration_rate() const { return penetration_rate_; }
  /// Displacements and velocities of the DOFs from z.
  [[nodiscard]] Eigen::VectorXd displacement(const Eigen::VectorXd& z) const;
  [[nodiscard]] Eigen::VectorXd velocity(const Eigen::VectorXd& z) const;
  /// Sets the known end of z, (1, sin, cos ...), at time t.
  void set_excitation(double t, Eigen::Ref<Eigen::VectorXd> z) const;
  /// Rows l with l z = const for the inner state: momenta of rigid motions that no damper resists.
  [[nodiscard]] const Eigen::MatrixXd& conserved() const { return conserved_; }

 private:
  struct Combination {
    std::vector<signed char> waves;
    Eigen::MatrixXd matrix, force;
    std::map<long long, Eigen::MatrixXd> propagators;  // by duration
  };
  void set_modes();
  void set_static();
  void set_errors();
  [[nodiscard]] Combination make(const LumpedSystem::Workspace& workspace) const;

  const LumpedSystem& system_;
  LumpedSystem::Workspace workspace_;
  Eigen::Index dofs_ = 0, elastic_ = 0;
  bool neutral_ = true;
  double w_ = 1;
  std::vector<double> rates_;                   // rad/s, above zero, of the harmonic errors
  Eigen::MatrixXd shapes_, b_;                  // elastic shapes first, then rigid ones; mesh vectors
  Eigen::MatrixXd stiffness_, damping_;         // K + K_Omega without meshes; C + G with them
  Eigen::VectorXd squares_, static_, preload_;  // squares of the elastic frequencies; q_s; static deflection beyond
                                                // half backlash
  Eigen::MatrixXd errors_, error_rates_;        // meshes x (sin, cos ...)
  Eigen::MatrixXd penetration_, penetration_rate_, conserved_;
  std::vector<Combination> combinations_;
};

}  // namespace annulus::dynamics
