#pragma once

#include <string>
#include <vector>

#include "core/csv.h"
#include "dynamics/planetary_stage.h"

namespace annulus::app {

/// The modes of one stage and what depends on its speed.
struct StageModes {
  struct Mode {
    double frequency = 0;  ///< Hz, undamped, at rest
    std::string kind;
    double damped_frequency = 0;  ///< Hz, in the carrier frame at the operating speed
    double damping_ratio = 0;     ///< there
    std::vector<double> strain;   ///< share of the strain energy per group
    std::vector<double> kinetic;  ///< share of the kinetic energy per body
  };
  std::vector<std::string> groups;  ///< sun_planet, ring_planet, planet_bearing, sun_support, ...
  std::vector<std::string> bodies;  ///< sun, ring, carrier, planets
  std::vector<Mode> list;           ///< rising frequency
  Csv shapes;                       ///< one row per mode, one column per freedom
  Csv campbell;                     ///< natural frequency of every mode over speed, undamped
  Csv critical_speeds;              ///< where mesh orders meet them
};

[[nodiscard]] StageModes stage_modes(const dynamics::PlanetaryStage& stage);

/// The text of modes.csv without its header lines.
[[nodiscard]] std::string modes_csv(const StageModes& modes);

}  // namespace annulus::app
