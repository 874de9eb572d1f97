#include "fem/condensation/harmonic_matrix.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <complex>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

/// Rigid motions of the whole ring that have circumferential harmonic `h`, seen at the low interface in the sector's
/// frame: axial translation and rotation about the axis for h = 0; translation and tilt, as x + i y, for h = 1.
std::vector<Eigen::VectorXcd> harmonic_rigid_motions(const CondensedSector& sector, int harmonic) {
  const bool out_of_plane = sector.dimension == 3 && !sector.axially_held();
  std::vector<Eigen::VectorXcd> motions;
  const auto add = [&](const auto& displacement) {
    Eigen::VectorXcd motion(sector.interface_stiffness.rows() / 2);
    Eigen::Index row = 0;
    for (std::size_t n = 0; n < sector.interface_points.size(); ++n) {
      const Eigen::Vector3cd& u = displacement(sector.interface_points[n]);
      for (int c = 0; c < sector.interface_dofs[n]; ++c) motion[row++] = u[c];
    }
    motions.push_back(motion);
  };
  const Eigen::Vector3cd axis(1, std::complex<double>(0, 1), 0);
  const auto cross = [](const Eigen::Vector3cd& a, const Eigen::Vector3d& p) {
    return Eigen::Vector3cd(a[1] * p[2] - a[2] * p[1], a[2] * p[0] - a[0] * p[2], a[0] * p[1] - a[1] * p[0]);
  };
  if (harmonic == 0) {
    add([&](const Eigen::Vector3d& p) { return cross(Eigen::Vector3cd(0, 0, 1), p); });
    if (out_of_plane) add([](const Eigen::Vector3d&) { return Eigen::Vector3cd(0, 0, 1); });
  } else if (harmonic == 1) {
    add([&](const Eigen::Vector3d&) -> const Eigen::Vector3cd& { return axis; });
    if (out_of_plane) add([&](const Eigen::Vector3d& p) { return cross(axis, p); });
  }
  // Orthonormal, so that one stiffness serves all.
  for (std::size_t i = 0; i < motions.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) motions[i] -= motions[j] * motions[j].dot(motions[i]);
    motions[i].normalize();
  }
  return motions;
}

}  // namespace

HarmonicMatrix::HarmonicMatrix(const CondensedSector& sector, SectorSupport support)
    : sector_(sector), support_(support) {
  const auto m = sector.interface_stiffness.rows() / 2;
  // Columns of the turned basis: u_high = Q v_next.
  const auto turn_columns = [&](Eigen::MatrixXd matrix) {
    sector.turn_columns(matrix, 0);
    return matrix;
  };
  const Eigen::MatrixXd half = turn_columns(sector.interface_stiffness.bottomRightCorner(m, m));
  const Eigen::MatrixXd high_high = turn_columns(half.transpose());
  diagonal_ = sector.interface_stiffness.topLeftCorner(m, m) + high_high;
  coupling_ = turn_columns(sector.interface_stiffness.topRightCorner(m, m));
  load_low_ = sector.interface_load.topRows(m);
  load_high_ = turn_columns(sector.interface_load.bottomRows(m).transpose()).transpose();
}

Eigen::MatrixXcd HarmonicMatrix::factor(int harmonic) const {
  using Complex = std::complex<double>;
  const Complex shift = std::polar(1.0, harmonic * sector_.pitch_angle);
  Eigen::MatrixXcd matrix = diagonal_.cast<Complex>() + shift * coupling_.cast<Complex>() +
                            std::conj(shift) * coupling_.transpose().cast<Complex>();
  if (support_ == SectorSupport::floating) {
    const double rigid_stiffness = diagonal_.diagonal().mean();
    for (const auto& motion : harmonic_rigid_motions(sector_, harmonic))
      matrix += rigid_stiffness * motion * motion.adjoint();
  }
  if (!lapack::cholesky(matrix))
    throw SolverError(fmt::format("no support resists harmonic {} of the deformation of the ring", harmonic));
  return matrix;
}

}  // namespace annulus::fem
