#pragma once

#include <Eigen/Core>
#include <optional>

#include "dynamics/steady_state/frequency_response.h"
#include "dynamics/steady_state/real_transform.h"
#include "dynamics/steady_state/sampled_meshes.h"

namespace annulus::dynamics {

/// Data that all samplings of one period have in common.
struct BalanceProblem {
  const LumpedSystem& system;
  const FrequencyResponse& response;
  Eigen::VectorXd mean_stiffness;   ///< of `response`
  double spacing = 0;               ///< rad/s, between the lines
  Eigen::MatrixXd transfer;         ///< of the meshes, at all lines of the finest sampling
  Eigen::MatrixXd static_transfer;  ///< at w = 0
  Eigen::VectorXd static_approach;  ///< of the constant load, at w = 0
  /// A load that changes in time, with what it does to the system with mean stiffness: amplitude x exp(i w t) + its
  /// conjugate.
  struct LoadLine {
    Eigen::Index line = 0;          ///< w = line x spacing
    Eigen::VectorXcd displacement;  ///< m, one per DOF
  };
  std::vector<LoadLine> load_lines{};
};
/// The number of periods of a load in that of a motion with lines at multiples of `spacing` (rad/s); absent where it is
/// no whole number from 1 to half the samples.
[[nodiscard]] std::optional<Eigen::Index> load_line(const HarmonicLoad& load, double spacing, Eigen::Index samples);
/// For a motion that repeats after `period` (s), with up to `samples`. System and response are referred to; the latter
/// has this stiffness (N/m, one per mesh). All loads must have a load_line().
[[nodiscard]] BalanceProblem balance_problem(const LumpedSystem& system, const FrequencyResponse& response,
                                             const Eigen::VectorXd& stiffness, double period, Eigen::Index samples);

/// Residual and derivative of the harmonic balance at one sampling. Matrices: samples x meshes.
class HarmonicBalance {
 public:
  HarmonicBalance(const BalanceProblem& problem, double period, Eigen::Index samples);

  /// Solves the linear problem: approaches from forces F = k (approach - start) + c (rate - start rate) + `force`.
  [[nodiscard]] Eigen::MatrixXd linear_solution(const Eigen::MatrixXd& start, const Eigen::MatrixXd& start_rate,
                                                const Eigen::MatrixXd& force);
  /// Residual z + H N(z) - H_0 f (m) at the approaches z; stores the forces and their derivatives.
  void residual(const Eigen::Ref<const Eigen::MatrixXd>& approach, Eigen::Ref<Eigen::MatrixXd> result);
  /// Derivative of the residual at the last `residual`, times `change`.
  void apply_derivative(const Eigen::Ref<const Eigen::MatrixXd>& change, Eigen::Ref<Eigen::MatrixXd> result);

  /// Time derivative of a periodic function.
  [[nodiscard]] Eigen::MatrixXd rate_of(const Eigen::Ref<const Eigen::MatrixXd>& values);
  /// The same function at `factor` times as many samples.
  [[nodiscard]] static Eigen::MatrixXd refined(const Eigen::MatrixXd& values, Eigen::Index factor);
  /// Displacement and velocity of all DOFs (DOFs x samples) at the last `residual`.
  void motion(Eigen::MatrixXd& displacement, Eigen::MatrixXd& velocity);

  [[nodiscard]] SampledMeshes& meshes() { return meshes_; }
  [[nodiscard]] Eigen::Index samples() const { return meshes_.samples(); }

 private:
  /// Writes H times the forces whose spectra are in `lines_` to the samples.
  void respond(Eigen::Ref<Eigen::MatrixXd> approach);
  void forward(const Eigen::Ref<const Eigen::MatrixXd>& values, Eigen::MatrixXcd& lines);

  const BalanceProblem& problem_;
  SampledMeshes meshes_;
  RealTransform transform_;
  Eigen::MatrixXcd lines_, approach_lines_;  // spectra, up to the Nyquist line, one column per mesh
  Eigen::VectorXcd line_;
  Eigen::MatrixXd loaded_;  // approaches under the loads, with mean stiffness
  Eigen::MatrixXd rate_, force_;
};

}  // namespace annulus::dynamics
