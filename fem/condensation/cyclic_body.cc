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

/// Stored offset and whether the block has to be transposed.
std::pair<int, bool> locate(int offset, int sectors, int max_offset) {
  int d = offset % sectors;
  if (d < 0) d += sectors;
  const bool mirrored = d > sectors - d;
  if (mirrored) d = sectors - d;
  require(d <= max_offset, "a compliance beyond the formed offsets was asked for");
  return {d, mirrored};
}

/// Inverses of the harmonics h = first, first + step, ... summed to compliances between cuts: m^2 x offsets.
Eigen::MatrixXd sum_harmonics(const CondensedSector& sector, const ChainedSector& chained, int sectors, int offsets,
                              int first, int step, bool floating) {
  constexpr int chunk = 8;  // harmonics summed by one matrix product
  const auto m = chained.diagonal.rows();
  const double rigid_stiffness = chained.diagonal.diagonal().mean();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(m * m, offsets);
  Eigen::MatrixXd inverses(m * m, 2 * chunk), turns(2 * chunk, offsets);
  const int harmonics = sectors / 2 + 1;
  for (int h = first, k = 0; h < harmonics; h += step) {
    const Complex shift = std::polar(1.0, h * sector.pitch_angle);
    Eigen::MatrixXcd matrix = chained.diagonal.cast<Complex>() + shift * chained.coupling.cast<Complex>() +
                              std::conj(shift) * chained.coupling.transpose().cast<Complex>();
    if (floating)
      for (const auto& motion : rigid_motions(sector, h)) matrix += rigid_stiffness * motion * motion.adjoint();
    if (!lapack::cholesky(matrix))
      throw SolverError("the ring is not held against its harmonic " + std::to_string(h) + " of deformation");
    lapack::invert_from_cholesky(matrix);
    inverses.col(2 * k) = matrix.real().reshaped();
    inverses.col(2 * k + 1) = matrix.imag().reshaped();
    // Harmonics h and N - h are conjugate.
    const double weight = (h == 0 || 2 * h == sectors ? 1.0 : 2.0) / sectors;
    for (int d = 0; d < offsets; ++d) {
      const Complex turn = std::polar(weight, h * d * sector.pitch_angle);
      turns(2 * k, d) = turn.real();
      turns(2 * k + 1, d) = -turn.imag();
    }
    if (++k < chunk && h + step < harmonics) continue;
    inverses.rightCols(2 * (chunk - k)).setZero();
    turns.bottomRows(2 * (chunk - k)).setZero();
    lapack::add_product(inverses, turns, sum);
    k = 0;
  }
  return sum;
}

}  // namespace

CyclicCompliance::CyclicCompliance(int sectors, int ports, int max_offset, std::vector<Eigen::MatrixXd> cuts,
                                   Eigen::MatrixXd low, Eigen::MatrixXd high, Eigen::MatrixXd within)
    : sectors_(sectors),
      cuts_(std::move(cuts)),
      low_(std::move(low)),
      high_(std::move(high)),
      within_(std::move(within)) {
  const Eigen::MatrixXd port_low = low_.leftCols(ports), port_high = high_.leftCols(ports);
  for (int d = 0; d <= max_offset; ++d) {
    Eigen::MatrixXd at_low = Eigen::MatrixXd::Zero(cut_size(), ports), at_high = at_low;
    add_cut_displacement(d, port_low, at_low);
    add_cut_displacement(d - 1, port_high, at_low);
    add_cut_displacement(d + 1, port_low, at_high);
    add_cut_displacement(d, port_high, at_high);
    blocks_.push_back(lapack::transpose_product(port_low, at_low) + lapack::transpose_product(port_high, at_high));
  }
  blocks_.front() += within_.topLeftCorner(ports, ports);
  blocks_.front() = (0.5 * (blocks_.front() + blocks_.front().transpose())).eval();
}

Eigen::MatrixXd CyclicCompliance::block(int offset) const {
  const auto [d, mirrored] = locate(offset, sectors_, max_offset());
  return mirrored ? Eigen::MatrixXd(blocks_[d].transpose()) : blocks_[d];
}

void CyclicCompliance::add_cut_displacement(int offset, const Eigen::MatrixXd& cut_load,
                                            Eigen::MatrixXd& displacement) const {
  const auto [d, mirrored] = locate(offset, sectors_, max_cut_offset());
  if (mirrored)
    displacement += lapack::transpose_product(cuts_[d], cut_load);
  else
    lapack::add_product(cuts_[d], cut_load, displacement);
}

CyclicCompliance compose_ring(const CondensedSector& sector, int sectors, const RingExtent& extent, bool floating,
                              int threads) {
  require(sectors >= 3, "a ring needs at least three sectors");
  const int max_offset = std::min(extent.max_offset, sectors / 2);
  const int offsets = extent.whole_ring ? sectors / 2 + 1 : std::min(max_offset + 1, sectors / 2) + 1;
  ChainedSector chained = chain(sector);

  // The harmonics are summed in a fixed number of groups, in order: the same result for any number of threads.
  constexpr int groups = 4;
  std::vector<Eigen::MatrixXd> partial(groups);
  std::vector<std::exception_ptr> failures(groups);
  std::atomic<int> next{0};
  const auto worker = [&] {
    for (int group = next++; group < groups; group = next++) try {
        partial[group] = sum_harmonics(sector, chained, sectors, offsets, group, groups, floating);
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
  for (int group = 1; group < groups; ++group) partial.front() += partial[group];

  const auto m = chained.diagonal.rows();
  std::vector<Eigen::MatrixXd> cuts;
  for (int d = 0; d < offsets; ++d) cuts.emplace_back(partial.front().col(d).reshaped(m, m));
  return {sectors,
          sector.ports,
          max_offset,
          std::move(cuts),
          std::move(chained.load_low),
          std::move(chained.load_high),
          sector.compliance};
}

}  // namespace annulus::fem
