#pragma once

#include <Eigen/Core>

#include "fem/condensation/condensed_sector.h"

namespace annulus::fem {

/// The stiffness of the cyclic interfaces of a ring of equal sectors, one Hermitian matrix per circumferential
/// harmonic: the displacements of interface s are v e^(i h s pitch), each seen in the frame of its own sector.
class HarmonicMatrix {
 public:
  /// A floating ring gets an artificial stiffness against its rigid motions alone (harmonics 0 and 1).
  /// `sector` is referred to.
  HarmonicMatrix(const CondensedSector& sector, SectorSupport support);

  /// Its Cholesky factor (lower). Throws SolverError when no support resists the harmonic.
  [[nodiscard]] Eigen::MatrixXcd factor(int harmonic) const;
  /// Loads on the own interface, m x loads.
  [[nodiscard]] const Eigen::MatrixXd& load_low() const { return load_low_; }
  [[nodiscard]] const Eigen::MatrixXd& load_high() const { return load_high_; }  ///< on the next, in its frame

 private:
  const CondensedSector& sector_;
  SectorSupport support_;
  Eigen::MatrixXd diagonal_, coupling_;  // A_0 and A_1 of the block-circulant matrix
  Eigen::MatrixXd load_low_, load_high_;
};

/// Tasks that the harmonics are shared out to: h = task, task + harmonic_groups, ... A fixed number, so that sums do
/// not depend on the number of threads.
inline constexpr int harmonic_groups = 4;

}  // namespace annulus::fem
