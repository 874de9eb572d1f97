#pragma once

#include <optional>
#include <string>

#include "app/systems/shared/space_results.h"
#include "core/csv.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// What bearings, supports and the sun do in the course of the evaluated window.
struct StageMotion {
  std::string section;                ///< period_1, period_n, irregular, undecided
  std::optional<int> section_period;  ///< mesh cycles
  int section_clusters = 0;           ///< distinct points of the Poincaré section
  Csv bearing_forces;                 ///< per mesh cycle
  SpaceResults space;                 ///< of a stage in space
  Csv sun_orbit;                      ///< over time
  Csv poincare;                       ///< once per mesh cycle
};

[[nodiscard]] StageMotion tabulated_motion(const dynamics::PlanetaryStage& stage,
                                           const dynamics::DynamicResponse& response);

}  // namespace annulus::app
