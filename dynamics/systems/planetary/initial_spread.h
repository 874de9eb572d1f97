#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/systems/planetary/study_point.h"

namespace annulus::dynamics {

struct InitialSpreadOptions {
  int random_starts = 8;  ///< beside the static equilibrium
  double factor = 3;      ///< static mesh deflections, see RandomStarts
  std::uint64_t seed = 1;
  /// Two motions are the same when none of their results (load sharing, peak factor, contact loss) differs by more
  /// than this share; steady windows agree far better.
  double same = 5e-3;
  SimulationOptions simulation{};  ///< always by time integration
};

/// The motion that one start leads to.
struct InitialStart {
  bool steady = false;
  int attractor = -1;  ///< index, in the order found; -1: not steady
  FigureSet figures;   ///< by the keys of planetary_figures
};

/// Results over several starts. Where several motions exist, no single one represents the stage.
struct InitialSpread {
  std::vector<InitialStart> starts;  ///< the static one first
  int attractors = 0;                ///< distinct steady motions
  int unsteady = 0;                  ///< starts from which windows did not repeat (chaos, or long transients)
  FigureSet low, high;               ///< ends of every result over all starts
};

/// Integrates the stage in time to its steady state from several starts. The result depends on stage, options and seed
/// alone. Throws what `simulate` throws, and InputError for unusable options.
[[nodiscard]] InitialSpread initial_spread(const PlanetaryStage& stage, const InitialSpreadOptions& options = {});

}  // namespace annulus::dynamics
