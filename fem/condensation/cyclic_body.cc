#include "fem/condensation/cyclic_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <complex>
#include <exception>
#include <thread>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

using Complex = std::complex<double>;

/// Rigid motions of the whole ring that have circumferential harmonic `h`, seen at the low cut in the sector's frame:
/// axial translation and rotation about the axis for h = 0; translation and tilt, as x + i y, for h = 1.
std::vector<Eigen::VectorXcd> rigid_motions(const CondensedSector& sector, int harmonic) {
  const int dim = sector.dimension;
  std::vector<Eigen::VectorXcd> motions;
  const auto add = [&](const auto& displacement) {
    Eigen::VectorXcd motion(static_cast<Eigen::Index>(sector.cut_points.size()) * dim);
    for (std::size_t n = 0; n < sector.cut_points.size(); ++n) {
      const Eigen::Vector3cd u = displacement(sector.cut_points[n]);
      for (int c = 0; c < dim; ++c) motion[static_cast<Eigen::Index>(n) * dim + c] = u[c];
    }
    motions.push_back(motion);
  };
  const Eigen::Vector3cd axis(1, Complex(0, 1), 0);
  const auto cross = [](const Eigen::Vector3cd& a, const Eigen::Vector3d& p) {
    return Eigen::Vector3cd(a[1] * p[2] - a[2] * p[1], a[2] * p[0] - a[0] * p[2], a[0] * p[1] - a[1] * p[0]);
  };
  if (harmonic == 0) {
    add([&](const Eigen::Vector3d& p) { return cross(Eigen::Vector3cd(0, 0, 1), p); });
    if (dim == 3) add([](const Eigen::Vector3d&) { return Eigen::Vector3cd(0, 0, 1); });
  } else if (harmonic == 1) {
    add([&](const Eigen::Vector3d&) -> const Eigen::Vector3cd& { return axis; });
    if (dim == 3) add([&](const Eigen::Vector3d& p) { return cross(axis, p); });
  }
  // Orthonormal, so that one stiffness serves all.
  for (std::size_t i = 0; i < motions.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) motions[i] -= motions[j] * motions[j].dot(motions[i]);
    motions[i].normalize();
  }
  return motions;
}

/// The cut stiffness and loads with the high cut turned into the frame of the next sector.
struct ChainedSector {
  Eigen::MatrixXd diagonal, coupling;   // A_0 and A_1 of the block-circulant matrix
  Eigen::MatrixXd load_low, load_high;  // m x ports
};

ChainedSector chain(const CondensedSector& sector) {
  const auto m = sector.cut_stiffness.rows() / 2;
  const int dim = sector.dimension;
  // Columns of the turned basis: u_high = Q v_next.
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(sector.pitch_angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto turn_columns = [&](Eigen::MatrixXd matrix) {
    for (Eigen::Index n = 0; n < m; n += dim)
      matrix.middleCols(n, dim) = (matrix.middleCols(n, dim) * turn.topLeftCorner(dim, dim)).eval();
    return matrix;
  };
  const Eigen::MatrixXd low_high = turn_columns(sector.cut_stiffness.topRightCorner(m, m));
  const Eigen::MatrixXd half = turn_columns(sector.cut_stiffness.bottomRightCorner(m, m));
  const Eigen::MatrixXd high_high = turn_columns(half.transpose());
  ChainedSector result;
  result.diagonal = sector.cut_stiffness.topLeftCorner(m, m) + high_high;
  result.coupling = low_high;
  result.load_low = sector.cut_load.topRows(m);
  result.load_high = turn_columns(sector.cut_load.bottomRows(m).transpose()).transpose();
  return result;
}

}  // namespace

std::pair<int, bool> CyclicCompliance::locate(int offset) const {
  int d = offset % sectors_;
  if (d < 0) d += sectors_;
  const bool mirrored = d > sectors_ - d;
  if (mirrored) d = sectors_ - d;
  require(d <= max_offset(), "a compliance block beyond the formed offsets was asked for");
  return {d, mirrored};
}

Eigen::MatrixXd CyclicCompliance::block(int offset) const {
  const auto [d, mirrored] = locate(offset);
  return mirrored ? Eigen::MatrixXd(blocks_[d].transpose()) : blocks_[d];
}

Eigen::MatrixXd CyclicCompliance::apply(int offset, int first_row, int rows, int first_column,
                                        const Eigen::MatrixXd& x) const {
  const auto [d, mirrored] = locate(offset);
  if (mirrored) return blocks_[d].block(first_column, first_row, x.rows(), rows).transpose() * x;
  return blocks_[d].block(first_row, first_column, rows, x.rows()) * x;
}

CyclicCompliance compose_ring(const CondensedSector& sector, int sectors, int max_offset, bool floating, int threads) {
  require(sectors >= 3, "a ring needs at least three sectors");
  max_offset = std::min(max_offset, sectors / 2);
  const ChainedSector chained = chain(sector);
  const auto ports = chained.load_low.cols();
  const int harmonics = sectors / 2 + 1;
  const double rigid_stiffness = chained.diagonal.diagonal().mean();

  // The harmonics are summed in a fixed number of groups, in order: the same result for any number of threads.
  constexpr int groups = 4;
  std::vector<std::vector<Eigen::MatrixXd>> partial(groups);
  std::vector<std::exception_ptr> failures(groups);
  const auto work = [&](int group) {
    auto& sum = partial[group];
    sum.assign(max_offset + 1, Eigen::MatrixXd::Zero(ports, ports));
    for (int h = group; h < harmonics; h += groups) {
      const Complex shift = std::polar(1.0, h * sector.pitch_angle);
      Eigen::MatrixXcd matrix = chained.diagonal.cast<Complex>() + shift * chained.coupling.cast<Complex>() +
                                std::conj(shift) * chained.coupling.transpose().cast<Complex>();
      if (floating)
        for (const auto& motion : rigid_motions(sector, h)) matrix += rigid_stiffness * motion * motion.adjoint();
      if (!lapack::cholesky(matrix))
        throw SolverError("the ring is not held against its harmonic " + std::to_string(h) + " of deformation");
      Eigen::MatrixXcd loads = chained.load_low.cast<Complex>() + std::conj(shift) * chained.load_high.cast<Complex>();
      lapack::solve_lower(matrix, loads);
      const Eigen::MatrixXcd product = lapack::gram(loads);
      // Harmonics h and N - h are conjugate.
      const double weight = (h == 0 || 2 * h == sectors ? 1.0 : 2.0) / sectors;
      for (int d = 0; d <= max_offset; ++d) {
        const Complex turn = std::polar(weight, h * d * sector.pitch_angle);
        sum[d] += turn.real() * product.real() - turn.imag() * product.imag();
      }
    }
  };
  std::atomic<int> next{0};
  const auto worker = [&] {
    for (int group = next++; group < groups; group = next++) try {
        work(group);
      } catch (...) {
        failures[group] = std::current_exception();
      }
  };
  std::vector<std::thread> pool;
  for (int t = 1; t < std::min(threads, groups); ++t) pool.emplace_back(worker);
  worker();
  for (auto& t : pool) t.join();
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);

  std::vector<Eigen::MatrixXd> blocks(max_offset + 1, Eigen::MatrixXd::Zero(ports, ports));
  blocks[0] = sector.port_compliance;
  for (const auto& group : partial)
    for (int d = 0; d <= max_offset; ++d) blocks[d] += group[d];
  return {sectors, std::move(blocks)};
}

}  // namespace annulus::fem
