#include "dynamics/steady_state/quasi_static_path.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "dynamics/steady_state/response_window.h"
#include "dynamics/steady_state/second_angle.h"
#include "dynamics/steady_state/two_frequencies.h"

namespace annulus::dynamics {

namespace {

Eigen::MatrixXd forces_at(const LumpedSystem& system, Eigen::Index count, double step) {
  return static_path(system, Eigen::VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1) * step)).force;
}

/// Forces as functions of both angles; nothing where so many values of the second one are not worth it.
std::optional<Eigen::MatrixXd> over_two_angles(const LumpedSystem& system, const TwoFrequencies& angles, int cycles,
                                               int positions_per_cycle, double step) {
  const Eigen::Index positions = static_cast<Eigen::Index>(angles.cycles) * positions_per_cycle;
  const auto at_angle = [&](double angle) {
    return forces_at(with_waves_at(system, angles, angle), positions, step).transpose().eval();
  };
  constexpr double same = 1e-4, turn = 2 * std::numbers::pi;
  constexpr int fewest = 5;
  for (int rows = fewest; 2 * rows * angles.cycles <= cycles; rows = 2 * rows - 1) {
    Eigen::MatrixXd force(positions * rows, static_cast<Eigen::Index>(system.meshes().size()));
    for (int row = 0; row < rows; ++row) force.middleRows(row * positions, positions) = at_angle(turn * row / rows);
    const double between = turn / (2 * rows);
    const double error = (at_second_angle(force, rows, between) - at_angle(between)).cwiseAbs().maxCoeff();
    if (error <= same * force.cwiseAbs().maxCoeff())
      return along_both_angles(force, rows, angles.second_rate * step,
                               static_cast<Eigen::Index>(cycles) * positions_per_cycle);
  }
  return std::nullopt;
}

}  // namespace

Eigen::MatrixXd quasi_static_forces(const LumpedSystem& system, double mesh_frequency, int cycles,
                                    int positions_per_cycle) {
  const double step = 1 / (positions_per_cycle * mesh_frequency);
  if (cycles > long_window)
    if (const auto angles = two_frequencies(system, mesh_frequency, cycles))
      if (const auto force = over_two_angles(system, *angles, cycles, positions_per_cycle, step))
        return force->transpose();
  return forces_at(system, static_cast<Eigen::Index>(cycles) * positions_per_cycle, step);
}

}  // namespace annulus::dynamics
