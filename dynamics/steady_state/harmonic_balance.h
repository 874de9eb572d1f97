#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

#include "dynamics/steady_state/frequency_response.h"
#include "dynamics/steady_state/real_transform.h"
#include "dynamics/steady_state/sampled_meshes.h"

namespace annulus::dynamics {

/// An error of a mesh that follows the second angle of a motion.
struct SecondWave {
  int mesh = 0;
  HarmonicError error;  ///< of a rate that is a multiple of the second one
};

/// Where a motion is sampled: over one period, or over two angles that advance at rates without a short common period.
/// The excitation repeats with the first angle; errors that do not are waves of the second one. The motion is a
/// function of both, q(2 pi t / period, second_rate t), with lines at w = j 2 pi / period + l second_rate.
struct BalanceGrid {
  double period = 0;  ///< s, of the first angle
  int rows = 1;       ///< values of the second angle, odd; 1: there is none
  double second_rate = 0;
  std::vector<SecondWave> waves{};

  [[nodiscard]] double spacing() const;  ///< rad/s, of the first angle
  /// Rate (rad/s) of line j of the first angle and line l of the second, which from (rows + 1) / 2 on is l - rows.
  [[nodiscard]] double rate(Eigen::Index j, int l) const;
};

/// Data that all samplings of one motion have in common.
struct BalanceProblem {
  const LumpedSystem& system;  ///< without the errors of the second angle
  const FrequencyResponse& response;
  Eigen::VectorXd mean_stiffness;  ///< of `response`
  BalanceGrid grid;
  /// Of the meshes, for each line of the second angle at all lines of the first one up to the finest sampling; without
  /// that at w = 0.
  std::vector<Eigen::MatrixXd> transfer;
  Eigen::MatrixXd static_transfer;  ///< at w = 0
  Eigen::VectorXd static_approach;  ///< of the constant load, at w = 0
  /// A load that changes in time, with what it does to the system with mean stiffness: amplitude x exp(i w t) + its
  /// conjugate.
  struct LoadLine {
    Eigen::Index line = 0;          ///< of the first angle
    Eigen::VectorXcd displacement;  ///< m, one per DOF
  };
  std::vector<LoadLine> load_lines{};
};
/// The number of periods of a load in that of a motion with lines at multiples of `spacing` (rad/s); absent where it is
/// no whole number from 1 to half the samples.
[[nodiscard]] std::optional<Eigen::Index> load_line(const HarmonicLoad& load, double spacing, Eigen::Index samples);
/// With up to `samples` of the first angle. System and response are referred to; the latter has this stiffness (N/m,
/// one per mesh). All loads must have a load_line().
[[nodiscard]] BalanceProblem balance_problem(const LumpedSystem& system, const FrequencyResponse& response,
                                             const Eigen::VectorXd& stiffness, BalanceGrid grid, Eigen::Index samples);
/// Transfer functions for more samples, where they are needed.
void resolve(BalanceProblem& problem, Eigen::Index samples);

/// Residual and derivative of the harmonic balance at one sampling. Matrices: samples x meshes, those of the first
/// angle in a row of the second one behind each other.
class HarmonicBalance {
  using Complex = std::complex<double>;

 public:
  /// `samples`: of the first angle.
  HarmonicBalance(const BalanceProblem& problem, Eigen::Index samples);

  /// Solves the linear problem: approaches from forces F = k (approach - start) + c (rate - start rate) + `force`.
  [[nodiscard]] Eigen::MatrixXd linear_solution(const Eigen::MatrixXd& start, const Eigen::MatrixXd& start_rate,
                                                const Eigen::MatrixXd& force);
  /// Residual z + H N(z) - H_0 f (m) at the approaches z; stores the forces and their derivatives.
  void residual(const Eigen::Ref<const Eigen::MatrixXd>& approach, Eigen::Ref<Eigen::MatrixXd> result);
  /// Derivative of the residual at the last `residual`, times `change`.
  void apply_derivative(const Eigen::Ref<const Eigen::MatrixXd>& change, Eigen::Ref<Eigen::MatrixXd> result);

  /// Time derivative of a periodic function.
  [[nodiscard]] Eigen::MatrixXd rate_of(const Eigen::Ref<const Eigen::MatrixXd>& values);
  /// The same function at `factor` times as many samples of the first angle.
  [[nodiscard]] static Eigen::MatrixXd refined(const Eigen::MatrixXd& values, Eigen::Index factor, int rows = 1);
  /// Approaches and rates of deflections (m), one per mesh and the same everywhere.
  void at_deflection(const Eigen::VectorXd& deflection, Eigen::MatrixXd& approach, Eigen::MatrixXd& rate);
  /// Forces (N) of approaches (m) and rates (m/s); stores their derivatives.
  void forces(const Eigen::MatrixXd& approach, const Eigen::MatrixXd& rate, Eigen::MatrixXd& force);
  /// Forces (N) at the instants themselves (just after a jump), and the flanks that press, mesh after mesh.
  void at_instants(const Eigen::MatrixXd& approach, const Eigen::MatrixXd& rate, Eigen::MatrixXd& force,
                   std::vector<LumpedSystem::Contact>& contact);
  /// Change of the forces with the approaches at the last `forces` or `residual`.
  [[nodiscard]] Eigen::MatrixXd force_change(const Eigen::MatrixXd& change) const;
  /// A function of both angles at `count` times of the first angle's spacing, from time 0.
  [[nodiscard]] Eigen::MatrixXd along(const Eigen::MatrixXd& values, Eigen::Index count) const;
  /// Displacement and velocity of all DOFs (DOFs x samples) at the last `residual`.
  void motion(Eigen::MatrixXd& displacement, Eigen::MatrixXd& velocity);

  /// Of the first row.
  [[nodiscard]] SampledMeshes& meshes() { return meshes_.front(); }
  [[nodiscard]] Eigen::Index samples() const { return meshes_.front().samples(); }  ///< of the first angle
  [[nodiscard]] int rows() const { return problem_.grid.rows; }

 private:
  [[nodiscard]] Eigen::Index lines_of_row() const { return samples() / 2 + 1; }
  /// Writes H times the forces whose spectra are in `lines_` to the samples.
  void respond(Eigen::Ref<Eigen::MatrixXd> approach);
  void forward(const Eigen::Ref<const Eigen::MatrixXd>& values, Eigen::MatrixXcd& lines);
  void to_lines(const double* values, Complex* lines);
  void to_values(Complex* lines, double* values);
  enum class Sense { forward, back };
  void across_rows(Complex* lines, Sense sense);

  const BalanceProblem& problem_;
  std::vector<SampledMeshes> meshes_;  // one per row
  RealTransform transform_;
  double scale_ = 0;                         // of both transforms one behind the other
  Eigen::VectorXd rate_of_;                  // rad/s, of every line; 0 at the Nyquist lines, which are left out
  Eigen::MatrixXd shift_, shift_rate_;       // errors of the second angle, rows x meshes
  Eigen::MatrixXcd lines_, approach_lines_;  // spectra, up to the Nyquist line, one column per mesh
  Eigen::VectorXcd line_;
  Eigen::MatrixXcd across_, turn_;  // scratch; exp(i angle) of rows x lines of the second angle
  Eigen::MatrixXd loaded_;          // approaches under the loads, with mean stiffness
  Eigen::MatrixXd rate_, force_;
};

}  // namespace annulus::dynamics
