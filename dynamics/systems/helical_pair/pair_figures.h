#pragma once

#include <vector>

#include "core/figure.h"
#include "dynamics/systems/helical_pair/pair_response.h"

namespace annulus::dynamics {

/// Natural frequencies among the results of a pair; its six degrees of freedom turn freely together.
inline constexpr int pair_frequencies = 5;

/// The results of the lumped model of a pair, each declared once.
[[nodiscard]] const std::vector<FigureSpec>& pair_figures();

/// Results of a response with their errors, by the keys above.
[[nodiscard]] FigureSet figures(const PairResponse& response);
/// The natural frequencies, by the keys above. Throws what `modes` throws.
[[nodiscard]] FigureSet frequency_figures(const HelicalPair& pair);

/// Largest and smallest mesh force in the direction of the load (that of the driving flanks without a torque), N.
struct LoadedForce {
  Figure largest, smallest;
};
[[nodiscard]] LoadedForce loaded_force(const PairResponse& response);

}  // namespace annulus::dynamics
