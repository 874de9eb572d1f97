#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/systems/shared/space_results.h"
#include "core/csv.h"
#include "core/not_known.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// What bearings, supports and the sun do over the evaluated window.
struct StageMotion {
  std::vector<double> pin_force_max;              ///< N, largest resultant on the pin of each planet
  std::vector<double> pin_force_mean_tangential;  ///< N
  double load_zone_min = not_known;               ///< rad, smallest of a planet bearing with clearance
  double sun_support_max = not_known, ring_support_max = not_known, carrier_support_max = not_known;  ///< N, resultant
  double held_torque_mean = not_known;   ///< N m, on the housing
  double sun_orbit_extent = not_known;   ///< m, largest distance from the mean position, carrier frame
  double sun_orbit_largest = not_known;  ///< m, largest distance from the axis
  std::string section;                   ///< period_1, period_n, irregular, undecided
  std::optional<int> section_period;     ///< mesh cycles
  int section_clusters = 0;              ///< distinct points of the Poincaré section
  Csv bearing_forces;                    ///< per mesh cycle
  SpaceResults space;                    ///< of a stage in space
  Csv sun_orbit;                         ///< over time
  Csv poincare;                          ///< once per mesh cycle
};

[[nodiscard]] StageMotion tabulated_motion(const dynamics::PlanetaryStage& stage,
                                           const dynamics::DynamicResponse& response);

}  // namespace annulus::app
