#pragma once

#include "app/systems/helical_pair/pair_run.h"

namespace annulus::app {

/// The results of a response that was found with `options`, with the errors that the stiffness table brings (see
/// dynamics/error_propagation); `response` receives their totals. Prescribed stiffness is exact.
[[nodiscard]] FigureSet carried_pair_errors(const PairRunResult& result, const dynamics::SimulationOptions& options,
                                            dynamics::PairResponse& response);

}  // namespace annulus::app
