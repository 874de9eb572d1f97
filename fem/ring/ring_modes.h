#pragma once

#include <limits>
#include <vector>

#include "core/ring_coupling.h"
#include "fem/ring/ring_flexibility.h"
#include "fem/ring/ring_on_supports.h"

namespace annulus::fem {

/// Which modes to keep.
struct ModeLimits {
  int count = 40;                                                      ///< one more where that would part a pair
  double highest_frequency = std::numeric_limits<double>::infinity();  ///< Hz
};

/// Elastic modes of a held ring, by circumferential harmonics. The mass is that of the motions (inertia_loads), so that
/// frequencies come down to those of the mesh from above as their orders rise.
///
///     y = omega^2 F y  (motions)       deflection = -omega^2 F_mesh,motions y,  y^T y = 1
///
/// Of the two modes of a pair one has its largest deflection at tooth 0, the other none there.
[[nodiscard]] std::vector<RingMode> held_ring_modes(const RingFlexibility& ring, const ModeLimits& limits);

/// The same of a ring on pins or splines, all of them held both ways (see RingOnSupports::held_compliance).
[[nodiscard]] std::vector<RingMode> supported_ring_modes(const RingFlexibility& ring, const RingOnSupports& supports,
                                                         const ModeLimits& limits);

}  // namespace annulus::fem
