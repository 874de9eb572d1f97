#pragma once

#include <algorithm>

#include "core/csv.h"
#include "core/ring_coupling.h"

namespace annulus::app {

/// How the meshes of one ring act on each other through it, solved, with what is needed to judge it.
struct SolvedCoupling {
  RingCoupling coupling;
  double mesh_compliance = 0;  ///< m/N, mean of a single mesh at the nominal load
  /// m/N, of a planet's path as far as it is known here: mesh and planet bearing. It decides how the load is shared.
  double path_compliance = 0;
  double compliance_error = 0;          ///< m/N, estimated
  double frequency_error_relative = 0;  ///< estimated
  double highest_frequency = 0;         ///< Hz, up to which modes were looked for
  double seconds = 0;
  bool reused = false;
  int reused_teeth = 0;  ///< condensed sectors that were read back
  Csv teeth{};           ///< ring_compliance.csv; empty once it is written

  /// m/N, largest entry of the coupling by magnitude.
  [[nodiscard]] double largest() const {
    double most = 0;
    for (const auto& matrix : coupling.compliance) most = std::max(most, matrix.cwiseAbs().maxCoeff());
    return most;
  }
};

}  // namespace annulus::app
