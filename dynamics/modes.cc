#include "dynamics/modes.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

/// Shares of the kinetic energy of a mode shape by which Lin and Parker tell the kinds apart.
struct EnergyShares {
  double central_translation = 0, central_rotation = 0;
  double planets_unlike = 0;  ///< of the planets' motion less its mean over the planets
};

EnergyShares shares_of(const LumpedSystem& system, int planets, const Eigen::VectorXd& shape) {
  EnergyShares shares;
  // Freedoms without mass coupling dominate; the diagonal is a fair weight, only zero or not zero matters.
  const auto weight = [&](int i, double amplitude) { return system.mass()(i, i) * amplitude * amplitude; };
  for (const std::string body : {"sun", "ring", "carrier"})
    for (const std::string direction : {"_x", "_y", "_u"}) {
      const int i = system.find(body + direction);
      if (i >= 0) (direction == "_u" ? shares.central_rotation : shares.central_translation) += weight(i, shape[i]);
    }
  for (const std::string direction : {"_x", "_y", "_u"}) {
    std::vector<int> index;
    double mean = 0;
    for (int n = 1; n <= planets; ++n)
      if (const int i = system.find("planet" + std::to_string(n) + direction); i >= 0) {
        index.push_back(i);
        mean += shape[i] / planets;
      }
    for (const int i : index) shares.planets_unlike += weight(i, shape[i] - mean);
  }
  return shares;
}

ModeKind kind_of(const EnergyShares& s) {
  // Shapes are normalised to unit kinetic energy; (1e-6)^2 is far above the solver's rounding and far below any
  // participation that means something.
  constexpr double nothing = 1e-12;
  if (s.central_translation < nothing && s.planets_unlike < nothing) return ModeKind::rotational;
  if (s.central_rotation >= nothing) return ModeKind::mixed;
  return s.central_translation < nothing ? ModeKind::planet : ModeKind::translational;
}

}  // namespace

std::string to_string(ModeKind kind) {
  switch (kind) {
    case ModeKind::rotational:
      return "rotational";
    case ModeKind::translational:
      return "translational";
    case ModeKind::planet:
      return "planet";
    case ModeKind::mixed:
      break;
  }
  return "mixed";
}

Modes modes(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness) {
  require(mesh_stiffness.size() == static_cast<Eigen::Index>(system.meshes().size()), "one stiffness per mesh");
  Modes result;
  result.freedoms = system.names();
  if (system.freedoms() == 0) return result;
  Eigen::MatrixXd stiffness = system.stiffness();
  for (int m = 0; m < mesh_stiffness.size(); ++m) {
    const Eigen::VectorXd b = system.mesh_vector(m);
    stiffness += mesh_stiffness[m] * b * b.transpose();
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, system.mass());
  if (solver.info() != Eigen::Success) throw SolverError("the eigenvalue solver for the natural frequencies failed");
  const auto& squares = solver.eigenvalues();
  // Rounding leaves squares of about 1e-16 x the largest (times the freedoms): below 1e-12 nothing is known but zero.
  const double zero = 1e-12 * squares.cwiseAbs().maxCoeff();
  for (int i = 0; i < squares.size(); ++i) {
    if (squares[i] < -zero) throw SolverError("the stiffness is indefinite: a support or mesh stiffness is negative");
    Mode mode;
    mode.frequency = squares[i] <= zero ? 0.0 : std::sqrt(squares[i]) / (2 * std::numbers::pi);
    mode.shape = solver.eigenvectors().col(i);
    result.modes.push_back(std::move(mode));
  }
  return result;
}

Modes modes(const PlanetaryStage& stage) {
  const LumpedSystem system = assemble(stage);
  Eigen::VectorXd stiffness(2 * stage.planets());
  stiffness.head(stage.planets()).setConstant(mean_tangent_stiffness(stage.sun_mesh));
  stiffness.tail(stage.planets()).setConstant(mean_tangent_stiffness(stage.ring_mesh));
  Modes result = modes(system, stiffness);
  for (auto& mode : result.modes) mode.kind = kind_of(shares_of(system, stage.planets(), mode.shape));
  return result;
}

}  // namespace annulus::dynamics
