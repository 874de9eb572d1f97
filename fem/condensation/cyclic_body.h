#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "fem/condensation/condensed_sector.h"

namespace annulus::fem {

/// Compliance of a body of N equal sectors at the ports of every sector.
///
/// block(d)(i, j) is the displacement at port i of sector s + d under a unit load at port j of sector s, each port
/// in the frame of its own sector. A body that floats is given with an artificial stiffness against its rigid motions
/// alone: exact, up to a rigid motion, for every set of loads in equilibrium.
class CyclicCompliance {
 public:
  CyclicCompliance() = default;
  CyclicCompliance(int sectors, std::vector<Eigen::MatrixXd> blocks) : sectors_(sectors), blocks_(std::move(blocks)) {}

  [[nodiscard]] int sectors() const { return sectors_; }
  [[nodiscard]] int max_offset() const { return static_cast<int>(blocks_.size()) - 1; }
  /// Any offset, taken modulo N to the nearest; throws InternalError beyond max_offset().
  [[nodiscard]] Eigen::MatrixXd block(int offset) const;
  /// block(offset).block(first_row, first_column, rows, x.rows()) * x without copying the whole block.
  [[nodiscard]] Eigen::MatrixXd apply(int offset, int first_row, int rows, int first_column,
                                      const Eigen::MatrixXd& x) const;

 private:
  /// Stored offset and whether the block has to be transposed.
  [[nodiscard]] std::pair<int, bool> locate(int offset) const;

  int sectors_ = 0;
  std::vector<Eigen::MatrixXd> blocks_;  // offsets 0 ... max
};

/// Composes the ring exactly by its block-circulant structure: one Hermitian system per circumferential harmonic.
/// Blocks for offsets 0 ... max_offset are formed. `threads` only changes the time, never the result.
[[nodiscard]] CyclicCompliance compose_ring(const CondensedSector& sector, int sectors, int max_offset, bool floating,
                                            int threads);

}  // namespace annulus::fem
