#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>

#include "dynamics/steady_state/response_window.h"
#include "dynamics/steady_state/two_frequencies.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

struct PeriodicOptions {
  /// Samples per mesh cycle, a multiple of 8. Harmonics of the mesh frequency up to half of it are solved.
  int samples_per_cycle = 32;
  /// Samples are doubled, up to `max_samples_per_cycle`, until neither that nor a look at more samples changes any
  /// force by more than this (N). Absent: no doubling, and no look.
  std::optional<double> sampling_tolerance{};
  int max_samples_per_cycle = 256;
  int max_samples_ahead = 256;  ///< per mesh cycle, for the look; from there on more harmonics are not looked for
  /// Largest residual of an approach at any sample / largest quasi-static mesh deflection at time 0.
  double tolerance = 1e-5;
  int max_iterations = 20;  ///< Newton iterations, per level of sampling
};

enum class PeriodicMethod {
  harmonic_balance,
  two_frequencies,  ///< harmonic balance over two angles
  piecewise,        ///< exact, for systems whose stiffness is constant between jumps, while no mesh loses contact
};

/// Course of the search for a periodic solution without time integration.
struct PeriodicSolution {
  PeriodicMethod method = PeriodicMethod::harmonic_balance;
  bool converged = false;
  std::string trouble;  ///< the cause where it did not converge
  double residual = 0;  ///< see PeriodicOptions::tolerance
  int newton_iterations = 0, linear_iterations = 0;
  /// Largest force difference to half the samples, or to more of them as far as known, / mean mesh force; at least the
  /// residual.
  double sampling_difference = 0;
  /// Largest modulus of a Floquet multiplier: over the period of a piecewise solution, over a mesh cycle of a harmonic
  /// balance whose stability was examined.
  std::optional<double> largest_multiplier{};
  int longer_angle = 0;  ///< of two frequencies: mesh cycles after which the slower of both angles repeats
};

/// Periodic steady state over one period from time 0, with the course of its search.
struct PeriodicResponse : PeriodicSolution, ResponseWindow {
  Eigen::MatrixXd coarse_force;  ///< N, solved with half the samples, at every other time
  /// Largest difference of a force between both samplings (N). It bounds the error of the finer one where the spectrum
  /// decays. With jumps that error is about a third of it (second order).
  double coarse_difference = 0;
  /// N, at the same times: after one iteration from this solution with the samples that the highest natural frequency
  /// needs. Half the samples and these agree where both lack the harmonics that resonate. Empty: not looked at.
  Eigen::MatrixXd finer_force;
  double finer_difference = 0;  ///< N, largest difference to `finer_force`
  [[nodiscard]] double largest_difference() const { return std::max(coarse_difference, finer_difference); }
};

/// Periodic response by harmonic balance with the nonlinear forces evaluated in time (alternating frequency-time)
/// [CameronGriffin1989], [KrackGross2019, ch. 2]. The approaches z = b^T q at the samples satisfy
///   z + H N(z) = H_0 f,  N = F(t, z, z') - k z - c z',  H(w) = B^T D(w)^-1 B (FrequencyResponse, mean tangents k).
/// Newton's method with GMRES and the exact derivative (KINSOL) solves them, first with few samples, then with twice as
/// many each time. A finer sampling than `samples_per_cycle` that does not converge is dropped.
///
/// The excitation must repeat after `period` (s), which spans `cycles` mesh cycles. The iteration starts from the
/// response with constant mesh stiffness and, where that fails, from the equilibria at all times. It finds stable and
/// unstable solutions. Rigid motions are fixed by nu^T M q = 0 in the mean over the period.
///
/// Without convergence the last iterate is returned with `converged` false. A system whose mesh vectors move gives
/// `trouble` alone. Throws InputError when period, options or a load out of balance cannot be used, SolverError when
/// the linear part is singular.
[[nodiscard]] PeriodicResponse periodic_response(const LumpedSystem& system, double period, int cycles,
                                                 const PeriodicOptions& options = {});

/// The same over two angles [KrackGross2019, sect. 2.6], as a response over one `period` of the whole: motion and
/// forces are functions of both, read where the period passes. Values of the second angle are added until they change
/// no force by more than a tenth of the sampling tolerance; what they changed last counts as a difference. It does not
/// converge where they would take longer than a whole period.
[[nodiscard]] PeriodicResponse two_frequency_response(const LumpedSystem& system, const TwoFrequencies& angles,
                                                      double period, int cycles, const PeriodicOptions& options = {});

}  // namespace annulus::dynamics
