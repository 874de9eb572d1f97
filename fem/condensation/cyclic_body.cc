#include "fem/condensation/cyclic_body.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/errors.h"
#include "core/parallel.h"
#include "fem/condensation/harmonic_matrix.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

using Complex = std::complex<double>;

/// Stored offset and whether the block has to be transposed.
std::pair<int, bool> locate(int offset, int sectors, int max_offset) {
  int d = offset % sectors;
  if (d < 0) d += sectors;
  const bool mirrored = d > sectors - d;
  if (mirrored) d = sectors - d;
  require(d <= max_offset, "a compliance over ", d, " sectors was asked for, formed are ", max_offset);
  return {d, mirrored};
}

/// Sums over harmonics of a ring.
struct HarmonicSum {
  Eigen::MatrixXd compliance;  ///< between interfaces, m^2 x offsets
  Eigen::MatrixXd carried;     ///< displacements of interfaces under probes, (m probes) x sectors
};

/// Inverses of the harmonics h = first, first + step, ... summed to compliances between interfaces, and their answers
/// to probes.
HarmonicSum sum_harmonics(const HarmonicMatrix& interfaces, double pitch, int sectors, int offsets, int first, int step,
                          const Eigen::MatrixXd& probes) {
  constexpr int chunk = 8;  // harmonics summed by one matrix product
  const auto m = interfaces.load_low().rows();
  HarmonicSum result{Eigen::MatrixXd::Zero(m * m, offsets), Eigen::MatrixXd::Zero(m * probes.cols(), sectors)};
  Eigen::MatrixXd& sum = result.compliance;
  Eigen::MatrixXd probe_low, probe_high;
  if (probes.cols() > 0) {
    probe_low = interfaces.load_low() * probes;
    probe_high = interfaces.load_high() * probes;
  }
  Eigen::MatrixXd inverses(m * m, 2 * chunk), turns(2 * chunk, offsets);
  const int harmonics = sectors / 2 + 1;
  for (int h = first, k = 0; h < harmonics; h += step) {
    Eigen::MatrixXcd matrix = interfaces.factor(h);
    lapack::invert_from_cholesky(matrix);
    const Eigen::VectorXcd entries = matrix.reshaped();
    inverses.col(2 * k) = entries.real();
    inverses.col(2 * k + 1) = entries.imag();
    // Harmonics h and N - h are conjugate.
    const double weight = (h == 0 || 2 * h == sectors ? 1.0 : 2.0) / sectors;
    if (probes.cols() > 0) {
      const Eigen::MatrixXcd answer = matrix * (probe_low + std::polar(1.0, -h * pitch) * probe_high);
      for (int d = 0; d < sectors; ++d)
        result.carried.col(d) += (std::polar(weight, h * d * pitch) * answer.reshaped()).real();
    }
    for (int d = 0; d < offsets; ++d) {
      const Complex turn = std::polar(weight, h * d * pitch);
      turns(2 * k, d) = turn.real();
      turns(2 * k + 1, d) = -turn.imag();
    }
    if (++k < chunk && h + step < harmonics) continue;
    inverses.rightCols(2 * (chunk - k)).setZero();
    turns.bottomRows(2 * (chunk - k)).setZero();
    lapack::add_product(inverses, turns, sum);
    k = 0;
  }
  return result;
}

}  // namespace

CyclicCompliance::CyclicCompliance(int sectors, int ports, int max_offset, std::vector<Eigen::MatrixXd> interfaces,
                                   Eigen::MatrixXd low, Eigen::MatrixXd high, Eigen::MatrixXd within)
    : sectors_(sectors),
      interfaces_(std::move(interfaces)),
      low_(std::move(low)),
      high_(std::move(high)),
      within_(std::move(within)) {
  const Eigen::MatrixXd port_low = low_.leftCols(ports), port_high = high_.leftCols(ports);
  for (int d = 0; d <= max_offset; ++d) {
    Eigen::MatrixXd at_low = Eigen::MatrixXd::Zero(interface_size(), ports), at_high = at_low;
    add_interface_displacement(d, port_low, at_low);
    add_interface_displacement(d - 1, port_high, at_low);
    add_interface_displacement(d + 1, port_low, at_high);
    add_interface_displacement(d, port_high, at_high);
    blocks_.push_back(lapack::transpose_product(port_low, at_low) + lapack::transpose_product(port_high, at_high));
  }
  blocks_.front() += within_.topLeftCorner(ports, ports);
  blocks_.front() = (0.5 * (blocks_.front() + blocks_.front().transpose())).eval();
}

Eigen::MatrixXd CyclicCompliance::block(int offset) const {
  const auto [d, mirrored] = locate(offset, sectors_, max_offset());
  return mirrored ? Eigen::MatrixXd(blocks_[d].transpose()) : blocks_[d];
}

void CyclicCompliance::add_interface_displacement(int offset, const Eigen::MatrixXd& interface_load,
                                                  Eigen::MatrixXd& displacement) const {
  const auto [d, mirrored] = locate(offset, sectors_, max_interface_offset());
  if (mirrored)
    displacement += lapack::transpose_product(interfaces_[d], interface_load);
  else
    lapack::add_product(interfaces_[d], interface_load, displacement);
}

CyclicCompliance compose_ring(const CondensedSector& sector, int sectors, const RingExtent& extent,
                              SectorSupport support, int threads, const Eigen::MatrixXd& probes,
                              std::vector<Eigen::MatrixXd>* carried) {
  require(sectors >= 3, "a ring needs at least three sectors, not ", sectors);
  const int max_offset = std::min(extent.max_offset, sectors / 2);
  const int offsets = extent.whole_ring ? sectors / 2 + 1 : std::min(max_offset + 1, sectors / 2) + 1;
  const HarmonicMatrix harmonics(sector, support);

  std::vector<HarmonicSum> partial(harmonic_groups);
  for_each_task(harmonic_groups, threads, [&](std::size_t group) {
    partial[group] = sum_harmonics(harmonics, sector.pitch_angle, sectors, offsets, static_cast<int>(group),
                                   harmonic_groups, probes);
  });
  for (int group = 1; group < harmonic_groups; ++group) {
    partial.front().compliance += partial[group].compliance;
    partial.front().carried += partial[group].carried;
  }

  const auto m = harmonics.load_low().rows();
  std::vector<Eigen::MatrixXd> interfaces;
  interfaces.reserve(offsets);
  for (int d = 0; d < offsets; ++d) interfaces.emplace_back(partial.front().compliance.col(d).reshaped(m, m));
  for (Eigen::Index p = 0; p < probes.cols(); ++p) carried->push_back(partial.front().carried.middleRows(p * m, m));
  return {
      sectors,          sector.ports, max_offset, std::move(interfaces), harmonics.load_low(), harmonics.load_high(),
      sector.compliance};
}

}  // namespace annulus::fem
