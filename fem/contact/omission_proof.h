#pragma once

#include "fem/contact/complementarity.h"
#include "fem/contact/pressure_elements.h"
#include "fem/contact/tooth_pairs.h"

namespace annulus::fem {

/// What the solved deflections make of the flanks that took no part in a contact problem.
struct OmissionProof {
  PairSlices not_apart;  ///< that the deflections may have closed
  /// m, along the normal, by which any of them or of the outermost pairs came nearer: a bound below the gap beyond
  /// which pairs are not searched, exact above it.
  double closest_approach = 0;
};

/// The forces of a solved position displace both flanks of an omitted pair. Its gap without load, less the largest
/// approach along them, is above zero where the pair carries nothing: the position is then the solution with the pair
/// as well. `cycle`: mesh cycle of the position. `gap_beyond` (m): that of the pairs beyond the outermost ones.
[[nodiscard]] OmissionProof prove_omissions(const ContactBodies& bodies, const ToothPairs& setup, int cycle,
                                            const ComplementaritySolution& solution, double gap_beyond);

}  // namespace annulus::fem
