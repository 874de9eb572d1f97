#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/condensation/condensed_sector.h"

namespace annulus::fem {

/// Compliance between the loads of a ring of N equal sectors, harmonic by harmonic: for a few loads per sector far
/// cheaper than CyclicCompliance, which couples the interfaces.
///
/// Loads f e^(i h s pitch) on sectors s give displacements F_h f e^(i h s pitch) of their work partners, all in the
/// frames of their own sectors. F_h is Hermitian, F_(N-h) its conjugate.
class CyclicFlexibility {
 public:
  CyclicFlexibility() = default;
  /// `harmonics`: F_h for h = 0 ... N/2.
  CyclicFlexibility(int sectors, std::vector<Eigen::MatrixXcd> harmonics);

  [[nodiscard]] int sectors() const { return sectors_; }
  [[nodiscard]] int harmonics() const { return static_cast<int>(harmonics_.size()); }
  [[nodiscard]] int loads() const { return static_cast<int>(harmonics_.front().rows()); }
  [[nodiscard]] const Eigen::MatrixXcd& harmonic(int h) const { return harmonics_[h]; }
  /// Number of real deformations that harmonic h stands for: 1 for h = 0 and N/2, else 2.
  [[nodiscard]] int multiplicity(int h) const { return h == 0 || 2 * h == sectors_ ? 1 : 2; }
  /// block(d)(i, j): displacement of load i of sector s + d under a unit load j of sector s; any offset.
  [[nodiscard]] const Eigen::MatrixXd& block(int offset) const;

 private:
  int sectors_ = 0;
  std::vector<Eigen::MatrixXcd> harmonics_;
  std::vector<Eigen::MatrixXd> blocks_;  // offsets 0 ... N - 1
};

/// Composes the ring exactly for the ports and acting loads of the sector. A floating one is as in CyclicCompliance.
/// `scale` multiplies the result (the plane knows loads per unit of width). `threads` only changes the time.
[[nodiscard]] CyclicFlexibility compose_loads(const CondensedSector& sector, int sectors, SectorSupport support,
                                              double scale, int threads);

}  // namespace annulus::fem
