#include "dynamics/systems/planetary/rotating_modes.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/errors.h"
#include "dynamics/systems/planetary/planetary_modes.h"

namespace annulus::dynamics {

namespace {

/// Eigenvalues below this share of the largest |lambda| are zero. A rigid motion is a double eigenvalue with one
/// eigenvector, which rounding splits by the root of 1e-16.
constexpr double nothing = 1e-6;

struct Matrices {
  Eigen::MatrixXd rate, stiffness;  ///< C + G, K + K_Omega with the meshes
};

Matrices matrices_of(const PlanetaryStage& stage, const LumpedSystem& system, ModeDamping damping) {
  Matrices m{system.gyroscopic(), stiffness_with_meshes(system, mean_mesh_stiffness(stage))};
  if (damping == ModeDamping::undamped) {
    m.stiffness += (system.rotating_stiffness() + system.rotating_stiffness().transpose()) / 2;  // no circulatory part
    return m;
  }
  m.stiffness += system.rotating_stiffness();
  m.rate += system.damping_with_meshes();
  return m;
}

RotatingMode mode_of(std::complex<double> value, double largest) {
  RotatingMode mode;
  if (std::abs(value) <= nothing * largest) return mode;
  mode.frequency = std::abs(value.imag()) / (2 * std::numbers::pi);
  mode.damping_ratio = -value.real() / std::abs(value);
  return mode;
}

/// Combines the shapes of equal frequencies so that each is of one kind.
void separate_multiples(const KindSorter& sorter, std::vector<RotatingMode>& modes) {
  for (std::size_t begin = 0, end = 0; begin < modes.size(); begin = end) {
    // The unsymmetric solver splits equal eigenvalues by about 1e-14 of the largest.
    const auto same = [&](const RotatingMode& a, const RotatingMode& b) {
      return b.frequency - a.frequency <= 1e-9 * b.frequency && std::abs(b.damping_ratio - a.damping_ratio) <= 1e-9;
    };
    for (end = begin + 1; end < modes.size() && same(modes[begin], modes[end]);) ++end;
    // Rigid motions come with one eigenvector for several eigenvalues: nothing to turn.
    if (end - begin == 1 || modes[begin].frequency == 0) continue;
    Eigen::MatrixXcd shapes(modes[begin].shape.size(), static_cast<Eigen::Index>(end - begin));
    for (std::size_t i = begin; i < end; ++i) shapes.col(static_cast<Eigen::Index>(i - begin)) = modes[i].shape;
    shapes = sorter.separated(shapes);
    for (std::size_t i = begin; i < end; ++i) modes[i].shape = shapes.col(static_cast<Eigen::Index>(i - begin));
  }
}

}  // namespace

RotatingModes rotating_modes(const PlanetaryStage& stage, ModeDamping damping) {
  const LumpedSystem system = assemble(stage);
  RotatingModes result{stage.carrier_speed, system.names(), {}};
  const Eigen::Index n = system.dofs();
  if (n == 0) return result;
  // In the modal coordinates of the stage at rest, time in units of the highest frequency, all entries are about one
  // and the masses drop out.
  const auto matrices = matrices_of(stage, system, damping);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> rest(
      stiffness_with_meshes(system, mean_mesh_stiffness(stage)), system.mass());
  if (rest.info() != Eigen::Success)
    throw SolverError(
        fmt::format("the eigenvalue solver failed for the natural frequencies of {} degrees of freedom", n));
  const Eigen::MatrixXd& basis = rest.eigenvectors();
  const double unit = std::sqrt(rest.eigenvalues().cwiseAbs().maxCoeff());
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  state.topRightCorner(n, n).setIdentity();
  state.bottomLeftCorner(n, n) = -basis.transpose() * matrices.stiffness * basis / (unit * unit);
  state.bottomRightCorner(n, n) = -basis.transpose() * matrices.rate * basis / unit;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(state);
  if (solver.info() != Eigen::Success)
    throw SolverError(fmt::format("the eigenvalue solver failed for the stage at {} rad/s", stage.carrier_speed));

  // One of each conjugate pair; eigenvalues without one (real, or zero) in pairs by size, given by the one nearer zero.
  const Eigen::VectorXcd values = solver.eigenvalues() * unit;
  const double largest = values.cwiseAbs().maxCoeff();
  std::vector<Eigen::Index> oscillating, others;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const bool rigid_motion = std::abs(values[i]) <= nothing * largest;
    if (!rigid_motion && values[i].imag() > 0) oscillating.push_back(i);
    if (rigid_motion || values[i].imag() == 0) others.push_back(i);
  }
  std::sort(others.begin(), others.end(),
            [&](Eigen::Index a, Eigen::Index b) { return std::abs(values[a]) < std::abs(values[b]); });
  for (std::size_t i = 0; i < others.size(); i += 2) oscillating.push_back(others[i]);
  require(static_cast<Eigen::Index>(oscillating.size()) == n,
          fmt::format("{} modes of {} degrees of freedom", oscillating.size(), n));

  for (const Eigen::Index i : oscillating) {
    RotatingMode mode = mode_of(values[i], largest);
    mode.shape = basis * solver.eigenvectors().col(i).head(n);
    Eigen::Index top = 0;
    (void)mode.shape.cwiseAbs().maxCoeff(&top);
    const double size = std::sqrt(std::abs(mode.shape.dot(system.mass() * mode.shape)));
    mode.shape *= std::conj(mode.shape[top]) / std::abs(mode.shape[top]) / size;
    result.modes.push_back(std::move(mode));
  }
  std::stable_sort(result.modes.begin(), result.modes.end(),
                   [](const RotatingMode& a, const RotatingMode& b) { return a.frequency < b.frequency; });
  const KindSorter sorter(system, stage.planets());
  separate_multiples(sorter, result.modes);
  for (auto& mode : result.modes) mode.kind = sorter(mode.shape);
  return result;
}

}  // namespace annulus::dynamics
