#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/figure.h"
#include "dynamics/figures/peaks.h"
#include "dynamics/steady_state/steady_response.h"

/// Results that are read from the motion in a steady state, and the windows of it that should agree about them.
namespace annulus::dynamics {

/// Every `step`-th time of a window, without its jumps and closer times.
[[nodiscard]] ResponseWindow samples_of(const ResponseWindow& window, int step = 1);

/// The largest difference (N) of a mesh force to other windows of which only the forces are known; 0 where there are
/// none. `meshes`: that many, the first ones.
[[nodiscard]] double force_difference(const SteadyResponse& found, Eigen::Index meshes);

/// Other windows with motion that should agree with the best one: the one before or the periodic solution, and the one
/// of a looser integration. Behind jumps motions may vibrate between the samples: then also every second of them.
[[nodiscard]] std::vector<ResponseWindow> compared_windows(const SteadyResponse& found);

/// A window at `pieces` times as many times up to its last sample: motions from displacements and velocities of the
/// samples by cubics, forces from these motions.
[[nodiscard]] ResponseWindow closer_samples(const LumpedSystem& system, const ResponseWindow& window, int pieces);

enum class ValueOf { all_times, one_instant };
/// A value of a window, and by how much it may change with a mesh force.
struct WindowValue {
  Peak peak{};
  double per_force = 0;  ///< its unit per N
  ValueOf of = ValueOf::one_instant;
};
/// By the keys of results.
using WindowValues = std::vector<std::pair<std::string, WindowValue>>;

/// The values of the best window. Their errors contain the sampling, the differences to the compared windows, and the
/// difference of mesh forces where nothing else is known. Behind jumps values of one instant are those of closer
/// samples, and their error contains what these change. `values` gives the same keys for every window.
[[nodiscard]] FigureSet window_figures(const LumpedSystem& system, const SteadyResponse& found,
                                       const std::function<WindowValues(const ResponseWindow&)>& values);

}  // namespace annulus::dynamics
