#include "fem/condensation/cyclic_flexibility.h"

#include <cmath>
#include <complex>

#include "core/errors.h"
#include "core/parallel.h"
#include "fem/condensation/harmonic_matrix.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {

CyclicFlexibility::CyclicFlexibility(int sectors, std::vector<Eigen::MatrixXcd> harmonics)
    : sectors_(sectors), harmonics_(std::move(harmonics)) {
  require(static_cast<int>(harmonics_.size()) == sectors / 2 + 1, "a cyclic flexibility of ", sectors, " sectors has ",
          harmonics_.size(), " harmonics");
  const auto n = harmonics_.front().rows();
  const double pitch = 2 * M_PI / sectors;
  blocks_.assign(sectors, Eigen::MatrixXd::Zero(n, n));
  for (int d = 0; d <= sectors / 2; ++d) {
    auto& block = blocks_[d];
    for (int h = 0; h < static_cast<int>(harmonics_.size()); ++h) {
      // The angle is reduced first: far offsets of high harmonics lose no digits.
      const std::complex<double> turn =
          std::polar(multiplicity(h) / static_cast<double>(sectors), (h * d % sectors) * pitch);
      block += harmonics_[h].real() * turn.real() - harmonics_[h].imag() * turn.imag();
    }
    if (d == 0 || 2 * d == sectors) block = (0.5 * (block + block.transpose())).eval();
    if (d > 0 && 2 * d < sectors) blocks_[sectors - d] = block.transpose();
  }
}

const Eigen::MatrixXd& CyclicFlexibility::block(int offset) const {
  return blocks_[((offset % sectors_) + sectors_) % sectors_];
}

CyclicFlexibility compose_loads(const CondensedSector& sector, int sectors, SectorSupport support, double scale,
                                int threads) {
  require(sectors >= 3, "a ring needs at least three sectors, not ", sectors);
  const HarmonicMatrix interfaces(sector, support);
  const auto loads = sector.compliance.cols();
  const Eigen::MatrixXcd low = interfaces.load_low().leftCols(loads), high = interfaces.load_high().leftCols(loads);
  const Eigen::MatrixXcd within = sector.compliance.topRows(loads);
  std::vector<Eigen::MatrixXcd> harmonics(sectors / 2 + 1);
  for_each_task(harmonic_groups, threads, [&](std::size_t group) {
    for (int h = static_cast<int>(group); h < static_cast<int>(harmonics.size()); h += harmonic_groups) {
      // A load of the sector before acts on its high interface.
      Eigen::MatrixXcd on_interface = low + std::polar(1.0, -h * sector.pitch_angle) * high;
      lapack::solve_lower(interfaces.factor(h), on_interface);
      const Eigen::MatrixXcd sum = scale * (within + on_interface.adjoint() * on_interface);
      harmonics[h] = 0.5 * (sum + sum.adjoint());
    }
  });
  return {sectors, std::move(harmonics)};
}

}  // namespace annulus::fem
