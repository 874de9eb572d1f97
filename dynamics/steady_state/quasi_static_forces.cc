#include "dynamics/steady_state/quasi_static_forces.h"

#include <numbers>
#include <optional>
#include <utility>

#include "dynamics/statics/static_solver.h"
#include "dynamics/steady_state/second_angle.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/steady_state/two_frequencies.h"

namespace annulus::dynamics {

namespace {

Eigen::VectorXd instants(Eigen::Index count, double step) {
  return Eigen::VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1) * step);
}

/// Forces as functions of both angles; nothing where so many values of the second one are not worth it.
std::optional<Eigen::MatrixXd> over_two_angles(const LumpedSystem& system, const TwoFrequencies& angles, int cycles,
                                               int positions_per_cycle, double step) {
  const Eigen::Index positions = static_cast<Eigen::Index>(angles.cycles) * positions_per_cycle;
  const Eigen::Index all = static_cast<Eigen::Index>(cycles) * positions_per_cycle;
  // A prime: the positions compared are spread over both angles.
  constexpr Eigen::Index apart = 31;
  const Eigen::Index compared = (all + apart - 1) / apart;
  const Eigen::MatrixXd expected = static_path(system, instants(compared, apart * step)).force;
  constexpr double same = 1e-4;
  constexpr int fewest = 5;
  for (int rows = fewest; 2 * rows * angles.cycles <= cycles; rows = 2 * rows - 1) {
    Eigen::MatrixXd force(positions * rows, expected.rows());
    for (int row = 0; row < rows; ++row) {
      const auto held = with_waves_at(system, angles, 2 * std::numbers::pi * row / rows);
      force.middleRows(row * positions, positions) = static_path(held, instants(positions, step)).force.transpose();
    }
    Eigen::MatrixXd found = along_both_angles(force, rows, angles.second_rate * step, all).transpose();
    const double error = (found(Eigen::all, Eigen::seqN(0, compared, apart)) - expected).cwiseAbs().maxCoeff();
    const double limit = same * expected.cwiseAbs().maxCoeff();
    if (error <= limit) return found;
    constexpr double two_steps = 16;  // twice as many values divide the error by four where teeth separate
    if (error > two_steps * limit) break;
  }
  return std::nullopt;
}

}  // namespace

Eigen::MatrixXd quasi_static_forces(const LumpedSystem& system, double mesh_frequency, int cycles,
                                    int positions_per_cycle) {
  const double step = 1 / (positions_per_cycle * mesh_frequency);
  if (cycles > long_window)
    if (const auto angles = two_frequencies(system, mesh_frequency, cycles))
      if (auto force = over_two_angles(system, *angles, cycles, positions_per_cycle, step)) return std::move(*force);
  return static_path(system, instants(static_cast<Eigen::Index>(cycles) * positions_per_cycle, step)).force;
}

}  // namespace annulus::dynamics
