#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

struct PeriodicOptions {
  /// Power of two times anything: samples per mesh cycle; harmonics of the mesh frequency up to half of it are solved.
  int samples_per_cycle = 32;
  /// Samples are doubled from there, up to `max_samples_per_cycle`, until that changed no force by more than this (N).
  /// Without: as many as said.
  std::optional<double> sampling_tolerance{};
  int max_samples_per_cycle = 256;
  /// Largest residual of a closing at any sample / largest quasi-static mesh deflection at time 0.
  double tolerance = 1e-5;
  int max_iterations = 20;  ///< Newton iterations, per level of sampling
  bool motion = true;       ///< also the displacements and velocities of all DOFs
};

/// Periodic steady state.
struct PeriodicResponse {
  bool converged = false;
  std::string trouble;                               ///< why it did not converge, empty otherwise
  double residual = 0;                               ///< as `tolerance`
  int newton_iterations = 0, linear_iterations = 0;  ///< over all levels of sampling
  int samples_per_cycle = 0;                         ///< of the answer

  Eigen::VectorXd time;                    ///< s, equidistant over one period from 0, its end not included
  Eigen::MatrixXd force;                   ///< N, meshes x times; just after a jump where a stiffness jumps
  Eigen::VectorXd open;                    ///< fraction of the samples without contact, per mesh
  Eigen::MatrixXd displacement, velocity;  ///< m, m/s, DOFs x times; empty without `motion`
  Eigen::MatrixXd coarse_force;            ///< N, solved with half the samples, at every other time
  /// Largest difference of a force between both samplings (N): bounds the error of the finer one where the spectrum
  /// decays; with jumps the error of the finer one is about a third of it (second order).
  double sampling_difference = 0;
};

/// Solves for the periodic response directly, by harmonic balance with the nonlinear forces evaluated in time
/// (alternating frequency-time): the closings z = b^T q at the samples satisfy
///   z + H N(z) = H_0 f,  N = F(t, z, z') - k z - c z',  H(w) = B^T D(w)^-1 B (FrequencyResponse, mean tangents k),
/// by Newton's method with GMRES and the exact derivative (KINSOL), first with few samples, then with twice as many
/// each time; a finer sampling than asked for that does not converge is dropped. Cameron and Griffin, J. Appl. Mech. 56
/// (1989); Krack and Gross, Harmonic Balance for Nonlinear Vibration Problems (2019).
///
/// The excitation must repeat after `period` (s), which spans `cycles` mesh cycles. Stable and unstable solutions alike
/// are found; the start is the response with constant mesh stiffness. Rigid motions are fixed by nu^T M q = 0 in the
/// mean over the period. Without convergence the last iterate is returned, with `converged` false; nothing but
/// `trouble` for a system whose mesh vectors move. Throws InputError when the load is not balanced, SolverError when
/// the linear part is singular.
[[nodiscard]] PeriodicResponse periodic_response(const LumpedSystem& system, double period, int cycles,
                                                 const PeriodicOptions& options = {});

}  // namespace annulus::dynamics
