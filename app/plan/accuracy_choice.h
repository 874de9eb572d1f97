#pragma once

#include <string>

#include "dynamics/steady_state/steady_response.h"

namespace annulus::app {

/// How the motion is found in time, and why (docs/tradeoff.md; for the stiffness: fem/choice/).
struct MotionChoice {
  int samples_per_cycle = 64;
  double relative_tolerance = 1e-5;  ///< of the time integration
  double steady_tolerance = 1e-3;    ///< see dynamics::SimulationOptions
  dynamics::Confirmation confirmation = dynamics::Confirmation::always;
  std::string samples_reason{}, tolerance_reason{}, confirm_reason{};
};
[[nodiscard]] MotionChoice motion_choice(double accuracy);

}  // namespace annulus::app
