#include "dynamics/systems/planetary/campbell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <tuple>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

bool one_frequency(const RotatingMode& a, const RotatingMode& b) {
  return std::abs(a.frequency - b.frequency) <= 1e-9 * std::max(a.frequency, b.frequency);
}

/// Modal assurance criterion |a_i^H M b_j|^2 of shapes normalised to 1. Rows of modes of one frequency are added up:
/// such modes are any basis of their space, and the space continues.
Eigen::MatrixXd mac_matrix(const RotatingModes& before, const RotatingModes& after, const Eigen::MatrixXd& mass) {
  const auto n = static_cast<Eigen::Index>(before.modes.size());
  Eigen::MatrixXcd a(n, n), b(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    a.col(i) = before.modes[i].shape;
    b.col(i) = after.modes[i].shape;
  }
  const Eigen::MatrixXd single = (a.adjoint() * mass * b).cwiseAbs2();
  Eigen::MatrixXd result = single;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      if (i != j && one_frequency(before.modes[i], before.modes[j])) result.row(i) += single.row(j);
  return result.cwiseMin(1.0);
}

/// For each mode of `before` its continuation in `after`: pairs with the largest MAC first. The MAC is rounded to
/// hundredths, so that among modes of equal MAC (a pair at rest) the nearer frequency decides, then the order.
std::vector<std::size_t> continuation(const RotatingModes& before, const RotatingModes& after,
                                      const Eigen::MatrixXd& mac) {
  const std::size_t n = before.modes.size();
  std::vector<std::tuple<double, double, std::size_t, std::size_t>> pairs;
  pairs.reserve(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      pairs.emplace_back(-std::round(100 * mac(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j))),
                         std::abs(before.modes[i].frequency - after.modes[j].frequency), i, j);
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::size_t> next(n, n);
  std::vector<bool> taken(n, false);
  for (const auto& [negative_mac, distance, i, j] : pairs)
    if (next[i] == n && !taken[j]) {
      next[i] = j;
      taken[j] = true;
    }
  return next;
}

/// See CriticalSpeed::participation.
double participation(const PlanetaryStage& stage, const LumpedSystem& system, const RotatingModes& modes,
                     std::size_t position, int order) {
  const int planets = stage.planets();
  const double sense = stage.mesh_rate() < 0 ? -1 : 1;  // of the mesh cycles
  double result = 0;
  for (const int first : {0, planets}) {
    Eigen::MatrixXd b(system.dofs(), planets);
    Eigen::VectorXcd pull(planets);  // of the order on each mesh
    for (int n = 0; n < planets; ++n) {
      b.col(n) = system.mesh_vector(first + n);
      pull[n] = std::polar(1.0, 2 * std::numbers::pi * order * sense * system.meshes()[first + n].phase_offset);
    }
    // The combination of modes of one frequency that is excited.
    Eigen::VectorXcd shape = Eigen::VectorXcd::Zero(system.dofs());
    for (const auto& mode : modes.modes)
      if (one_frequency(mode, modes.modes[position])) shape += mode.shape * mode.shape.dot(b * pull);
    const Eigen::VectorXcd approach = b.transpose() * shape;
    // Shapes have unit kinetic energy: an approach of 1e-9 is rounding.
    if (shape.norm() > 1e-9) result = std::max(result, std::abs(approach.dot(pull)) / approach.cwiseAbs().sum());
  }
  return result;
}

}  // namespace

std::vector<RotatingMode> modes_at_speed(const PlanetaryStage& stage) {
  const auto turning = rotating_modes(stage, ModeDamping::damped);
  PlanetaryStage still = stage;
  still.bearing_speed = stage.carrier_speed;
  still.carrier_speed = still.ring_speed = 0;
  const auto rest = rotating_modes(still, ModeDamping::undamped);
  std::vector<RotatingMode> modes;
  for (const std::size_t i : continuation(rest, turning, mac_matrix(rest, turning, assemble(still).mass())))
    modes.push_back(turning.modes[i]);
  return modes;
}

Campbell campbell(const PlanetaryStage& stage, const std::vector<double>& speeds, const CampbellOptions& options) {
  if (speeds.empty() || speeds.front() < 0 || options.orders < 0)
    throw InputError(fmt::format(
        "a Campbell diagram needs speeds of zero or more and orders of zero or more; it has {} speeds, the first {} "
        "rad/s, and {} orders",
        speeds.size(), speeds.empty() ? 0.0 : speeds.front(), options.orders));
  for (std::size_t i = 1; i < speeds.size(); ++i)
    if (!(speeds[i] > speeds[i - 1]))
      throw InputError(fmt::format("the speeds of a Campbell diagram must rise; {} rad/s follows {} rad/s", speeds[i],
                                   speeds[i - 1]));
  const double rolling = stage.carrier_speed - stage.ring_speed;
  const double carrier_share = rolling == 0 ? 1 : stage.carrier_speed / std::abs(rolling),
               ring_share = rolling == 0 ? 0 : stage.ring_speed / std::abs(rolling);
  PlanetaryStage at = stage;
  Campbell result;
  result.speeds = speeds;
  const LumpedSystem system = assemble(stage);
  const std::size_t n = system.names().size();
  result.curves.resize(n);

  RotatingModes before;
  std::vector<std::size_t> position(n);  // of each curve in the modes of the speed before
  std::iota(position.begin(), position.end(), std::size_t{0});
  for (std::size_t s = 0; s < speeds.size(); ++s) {
    at.carrier_speed = speeds[s] * carrier_share;
    at.ring_speed = speeds[s] * ring_share;
    result.mesh_frequency.push_back(at.mesh_frequency());
    auto now = rotating_modes(at, options.damping);
    Eigen::MatrixXd mac;
    std::vector<std::size_t> next(n);
    if (s > 0) {
      mac = mac_matrix(before, now, system.mass());
      next = continuation(before, now, mac);
    }
    for (std::size_t c = 0; c < n; ++c) {
      auto& curve = result.curves[c];
      const std::size_t old = position[c];
      if (s > 0) position[c] = next[old];
      const auto& mode = now.modes[position[c]];
      curve.frequency.push_back(mode.frequency);
      curve.damping_ratio.push_back(mode.damping_ratio);
      curve.mac.push_back(s > 0 ? mac(static_cast<Eigen::Index>(old), static_cast<Eigen::Index>(position[c])) : 1.0);
      if (s <= 1) curve.kind = mode.kind;
      if (s == 0) continue;
      for (int h = 1; h <= options.orders; ++h) {
        const double gap_before = curve.frequency[s - 1] - h * result.mesh_frequency[s - 1];
        const double gap = curve.frequency[s] - h * result.mesh_frequency[s];
        // The end belongs to the interval, the beginning does not: a crossing at a given speed is found once.
        if (gap_before == 0 || (gap != 0 && (gap_before > 0) == (gap > 0))) continue;
        const double part = gap_before / (gap_before - gap);
        result.crossings.push_back({static_cast<int>(c), h, speeds[s - 1] + part * (speeds[s] - speeds[s - 1]),
                                    (1 - part) * curve.frequency[s - 1] + part * curve.frequency[s],
                                    participation(stage, system, now, position[c], h)});
      }
    }
    before = std::move(now);
  }
  std::stable_sort(result.crossings.begin(), result.crossings.end(),
                   [](const CriticalSpeed& a, const CriticalSpeed& b) { return a.speed < b.speed; });
  return result;
}

}  // namespace annulus::dynamics
