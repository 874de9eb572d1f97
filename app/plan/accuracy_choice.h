#pragma once

#include <string>

namespace annulus::app {

/// How the motion is found in time, and why (docs/tradeoff.md; for the stiffness: fem/choice/).
struct MotionChoice {
  int samples_per_cycle = 64;
  double relative_tolerance = 1e-5;  ///< of the time integration
  double steady_tolerance = 1e-3;    ///< see dynamics::SimulationOptions
  bool confirm = true;               ///< confirm the harmonic balance by time integration also where no contact is lost
  std::string samples_reason{}, tolerance_reason{}, confirm_reason{};
};
[[nodiscard]] MotionChoice motion_choice(double accuracy);

}  // namespace annulus::app
