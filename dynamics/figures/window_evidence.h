#pragma once

#include <functional>
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

/// By how much the largest force of a mesh at closer times, or on both sides of jumps, differs from that of the samples
/// (N), the largest of the first `meshes` meshes.
[[nodiscard]] double force_between_samples(const ResponseWindow& window, Eigen::Index meshes);

enum class ValueOf { all_times, one_instant };
/// A value of a window, and by how much it may change with a mesh force.
struct WindowValue {
  Peak peak{};
  double per_force = 0;  ///< its unit per N
  ValueOf of = ValueOf::one_instant;
};
/// The values of the best window. Their errors contain the sampling, the differences to the compared windows, and the
/// difference of the forces of the first `meshes` meshes where nothing else is known; those of one instant what forces
/// do between the samples, too. `values` gives the same number of values for every window.
[[nodiscard]] std::vector<Figure> window_figures(
    const SteadyResponse& found, Eigen::Index meshes,
    const std::function<std::vector<WindowValue>(const ResponseWindow&)>& values);

}  // namespace annulus::dynamics
