#pragma once

#include <string>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// The small free motion of a system that grows fastest, all teeth in contact, with the mean tangents of the meshes:
/// the eigenvalue lambda of M q'' + (C + G) q' + (K + K_Omega) q = 0 with the largest real part. A growth below 1e-7 of
/// the largest eigenvalue counts as none: rounding of rigid motions.
struct Growth {
  double rate = 0;       ///< 1/s, Re lambda; not above 0: every motion dies out or stays
  double frequency = 0;  ///< Hz, |Im lambda| / 2 pi; 0: without oscillation
  std::string dof;       ///< the one that moves most
};
/// None, with a warning in the log, where the eigenvalues are not found.
[[nodiscard]] Growth fastest_growth(const LumpedSystem& system);

/// Relative growth per mesh cycle that counts as none: double zero eigenvalues are 1e-7 from it, and a thousandfold
/// growth over a thousand cycles would not pass unseen.
inline constexpr double unseen_growth = 1e-4;

/// Throws InputError where small free motions grow by more than unseen_growth per mesh cycle (and fastest_growth() sees
/// it): no motion near equilibrium lasts in such a system. `mesh_frequency` in Hz.
void refuse_growth(const LumpedSystem& system, double mesh_frequency);

}  // namespace annulus::dynamics
