#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/condensation/condensed_sector.h"

namespace annulus::fem {

/// A ring of equal sectors in which a few neighbours have been replaced by sectors that differ inside but share their
/// cyclic interfaces: teeth with a mesh of their own. Exact: the replacement is a change of low rank of the composed
/// ring.
class AlteredRing {
 public:
  /// `most`: largest number of neighbours that will be replaced at once.
  AlteredRing(const CondensedSector& regular, int sectors, int most, int threads);

  /// Compliance of all ports of the replaced sectors, which follow each other counter-clockwise: ports of the first
  /// sector, then of the second, ..., each in the frame of its own sector.
  [[nodiscard]] Eigen::MatrixXd compliance(const std::vector<const CondensedSector*>& replaced) const;

 private:
  Eigen::MatrixXd regular_stiffness_;                  // of the two interfaces, both in the frames of their own sectors
  std::vector<Eigen::MatrixXd> interface_compliance_;  // offsets 0 ... most
};

}  // namespace annulus::fem
