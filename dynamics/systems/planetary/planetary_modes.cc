#include "dynamics/systems/planetary/planetary_modes.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "core/errors.h"
#include "dynamics/modes/dense_spectrum.h"

namespace annulus::dynamics {

namespace {

/// Eigenvalues below this share of the largest |lambda| are zero. A rigid motion is a double eigenvalue with one
/// eigenvector, which rounding splits by the root of 1e-16.
constexpr double nothing = 1e-6;

struct Matrices {
  Eigen::MatrixXd rate, stiffness;  ///< C + G, K + K_Omega with the meshes
};

Matrices matrices_of(const LumpedSystem& system, ModeDamping damping) {
  Matrices m{system.gyroscopic(), stiffness_with_meshes(system, mean_tangents(system))};
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

/// Distinguishes the kinds by shares of the kinetic energy. DOFs are identified by their names (sun_x, planet1_u, ...);
/// others, such as elastic ones, are ignored.
class KindSorter {
 public:
  KindSorter(const LumpedSystem& system, int planets);

  /// Kind of a shape normalised to shape^H M shape = 1.
  [[nodiscard]] ModeKind operator()(const Eigen::VectorXcd& shape) const;
  /// Turns the shapes of every run of modes that are `same` as the first of their run, which are any basis of their
  /// space, so that each is of one kind, where such a basis exists. Throws SolverError for dependent shapes.
  template <class Mode, class Same>
  void separate_multiples(std::vector<Mode>& modes, const Same& same) const;

 private:
  template <class Matrix>
  [[nodiscard]] Matrix separated(const Matrix& shapes) const;

  Eigen::MatrixXd mass_;
  // Rows: root of the mass x amplitude of a motion that distinguishes kinds; the norm of map x shape is its energy.
  Eigen::MatrixXd central_translation_, central_rotation_;
  Eigen::MatrixXd planets_unlike_;  ///< the planets' motion less its mean over the planets
};

KindSorter::KindSorter(const LumpedSystem& system, int planets) : mass_(system.mass()) {
  const int n = system.dofs();
  std::vector<Eigen::RowVectorXd> translation, rotation, unlike;
  // The diagonal of the mass is a fair weight where masses are coupled: only zero or not zero matters.
  const auto row = [&](int i) {
    Eigen::RowVectorXd r = Eigen::RowVectorXd::Zero(n);
    r[i] = std::sqrt(mass_(i, i));
    return r;
  };
  const std::vector<std::string> directions{"_x", "_y", "_u", "_z", "_tiltx", "_tilty"};
  for (const std::string body : {"sun", "ring", "carrier"})
    for (const auto& direction : directions)
      if (const int i = system.find(body + direction); i >= 0)
        (direction == "_u" || direction == "_z" ? rotation : translation).push_back(row(i));
  for (const auto& direction : directions) {
    std::vector<int> index;
    for (int p = 1; p <= planets; ++p)
      if (const int i = system.find("planet" + std::to_string(p) + direction); i >= 0) index.push_back(i);
    for (const int i : index) {
      Eigen::RowVectorXd r = row(i);
      for (const int j : index) r[j] -= std::sqrt(mass_(i, i)) / static_cast<double>(index.size());
      unlike.push_back(r);
    }
  }
  const auto stacked = [n](const std::vector<Eigen::RowVectorXd>& rows) {
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), n);
    for (std::size_t i = 0; i < rows.size(); ++i) matrix.row(static_cast<Eigen::Index>(i)) = rows[i];
    return matrix;
  };
  central_translation_ = stacked(translation);
  central_rotation_ = stacked(rotation);
  planets_unlike_ = stacked(unlike);
}

ModeKind KindSorter::operator()(const Eigen::VectorXcd& shape) const {
  // (1e-6)^2 is far above the solver's rounding and far below any participation that means something.
  constexpr double rounding = 1e-12;
  const bool translates = (central_translation_ * shape).squaredNorm() >= rounding;
  const bool turns = (central_rotation_ * shape).squaredNorm() >= rounding;
  if (!translates && (planets_unlike_ * shape).squaredNorm() < rounding) return ModeKind::rotational;
  if (turns) return ModeKind::mixed;
  return translates ? ModeKind::translational : ModeKind::planet;
}

template <class Matrix>
Matrix KindSorter::separated(const Matrix& shapes) const {
  // The form |unlike|^2 + 2 |translation|^2 is 0 for rotational, 1 for planet and above 1 for translational shapes.
  const Matrix unlike = planets_unlike_ * shapes, translation = central_translation_ * shapes;
  const Matrix form = unlike.adjoint() * unlike + 2 * translation.adjoint() * translation;
  const Matrix gram = shapes.adjoint() * mass_ * shapes;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(form, gram);
  if (solver.info() != Eigen::Success)
    throw SolverError(fmt::format("{} shapes of a multiple natural frequency are not independent", shapes.cols()));
  return shapes * solver.eigenvectors();
}

template <class Mode, class Same>
void KindSorter::separate_multiples(std::vector<Mode>& modes, const Same& same) const {
  using Shape = decltype(Mode::shape);
  for (std::size_t begin = 0, end = 0; begin < modes.size(); begin = end) {
    for (end = begin + 1; end < modes.size() && same(modes[begin], modes[end]);) ++end;
    if (end - begin == 1) continue;
    Eigen::Matrix<typename Shape::Scalar, Eigen::Dynamic, Eigen::Dynamic> shapes(
        modes[begin].shape.size(), static_cast<Eigen::Index>(end - begin));
    for (std::size_t i = begin; i < end; ++i) shapes.col(static_cast<Eigen::Index>(i - begin)) = modes[i].shape;
    shapes = separated(shapes);
    for (std::size_t i = begin; i < end; ++i) modes[i].shape = shapes.col(static_cast<Eigen::Index>(i - begin));
  }
}

}  // namespace

std::string to_string(ModeKind kind, Motions motions) {
  const bool in_space = motions == Motions::in_space;
  switch (kind) {
    case ModeKind::rotational:
      return in_space ? "rotational-axial" : "rotational";
    case ModeKind::translational:
      return in_space ? "translational-tilting" : "translational";
    case ModeKind::planet:
      return "planet";
    case ModeKind::mixed:
      break;
  }
  return "mixed";
}

ModalEnergy modal_energy(const PlanetaryStage& stage, const Modes& modes) {
  const LumpedSystem system = assemble(stage);
  return modal_energy(system, mean_tangents(system), modes);
}

PlanetaryModes modes(const PlanetaryStage& stage) {
  const LumpedSystem system = assemble(stage);
  PlanetaryModes result{modes(system), {}};
  const KindSorter sorter(system, stage.planets());
  // Rounding splits equal frequencies by some 1e-15 of the highest; different kinds so close together are equal for
  // every purpose.
  constexpr double same = 1e-9, of_the_highest = 1e-14;
  const double resolved = result.modes.empty() ? 0 : of_the_highest * result.modes.back().frequency;
  sorter.separate_multiples(result.modes, [&](const Mode& a, const Mode& b) {
    return b.frequency - a.frequency <= same * b.frequency + resolved;
  });
  for (const auto& mode : result.modes) result.kinds.push_back(sorter(mode.shape));
  return result;
}

RotatingModes rotating_modes(const PlanetaryStage& stage, ModeDamping damping) {
  const LumpedSystem system = assemble(stage);
  RotatingModes result{stage.carrier_speed, system.names(), {}};
  const Eigen::Index n = system.dofs();
  if (n == 0) return result;
  // In the modal coordinates of the stage at rest, time in units of the highest frequency, all entries are about one
  // and the masses drop out.
  const auto matrices = matrices_of(system, damping);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> rest(
      stiffness_with_meshes(system, mean_tangents(system)), system.mass());
  if (rest.info() != Eigen::Success)
    throw SolverError(
        fmt::format("the eigenvalue solver failed for the natural frequencies of {} degrees of freedom", n));
  const Eigen::MatrixXd& basis = rest.eigenvectors();
  const double unit = std::sqrt(rest.eigenvalues().cwiseAbs().maxCoeff());
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  state.topRightCorner(n, n).setIdentity();
  state.bottomLeftCorner(n, n) = -basis.transpose() * matrices.stiffness * basis / (unit * unit);
  state.bottomRightCorner(n, n) = -basis.transpose() * matrices.rate * basis / unit;
  const auto found = eigenpairs(state);
  if (!found)
    throw SolverError(fmt::format("the eigenvalue solver failed for the stage at {} rad/s", stage.carrier_speed));

  // One of each conjugate pair; eigenvalues without one (real, or zero) in pairs by size, given by the one nearer zero.
  const Eigen::VectorXcd values = found->values * unit;
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
    mode.shape = basis * found->vectors.col(i).head(n);
    Eigen::Index top = 0;
    (void)mode.shape.cwiseAbs().maxCoeff(&top);
    const double size = std::sqrt(std::abs(mode.shape.dot(system.mass() * mode.shape)));
    mode.shape *= std::conj(mode.shape[top]) / std::abs(mode.shape[top]) / size;
    result.modes.push_back(std::move(mode));
  }
  std::stable_sort(result.modes.begin(), result.modes.end(),
                   [](const RotatingMode& a, const RotatingMode& b) { return a.frequency < b.frequency; });
  const KindSorter sorter(system, stage.planets());
  // The unsymmetric solver splits equal eigenvalues by about 1e-14 of the largest. Rigid motions come with one
  // eigenvector for several eigenvalues: nothing to turn.
  sorter.separate_multiples(result.modes, [](const RotatingMode& a, const RotatingMode& b) {
    return a.frequency > 0 && b.frequency - a.frequency <= 1e-9 * b.frequency &&
           std::abs(b.damping_ratio - a.damping_ratio) <= 1e-9;
  });
  for (auto& mode : result.modes) mode.kind = sorter(mode.shape);
  return result;
}

}  // namespace annulus::dynamics
