#pragma once

#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "core/csv.h"
#include "core/figure.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::app {

/// The modes of one stage and what depends on its speed.
struct StageModes {
  struct Mode {
    double frequency = 0;        ///< Hz, undamped, at rest
    double frequency_error = 0;  ///< Hz, what the errors of the mesh stiffnesses do to it
    ErrorParts error_parts{};    ///< Hz, of frequency_error
    std::string kind;
    double damped_frequency = 0;  ///< Hz, in the carrier frame at the operating speed
    double damping_ratio = 0;     ///< there
    std::vector<double> strain;   ///< share of the strain energy per group
    std::vector<double> kinetic;  ///< share of the kinetic energy per body
  };
  std::vector<std::string> groups;  ///< sun_planet, ring_planet, planet_bearing, sun_support, ...
  std::vector<std::string> bodies;  ///< sun, ring, carrier, planets
  std::vector<Mode> list;           ///< rising frequency
  Csv shapes;                       ///< one row per mode, one column per DOF
  Csv campbell;                     ///< natural frequency of every mode over speed, undamped
  Csv critical_speeds;              ///< where mesh orders meet them
};

/// Relative errors of the mean mesh stiffnesses; 0 for given ones, which count as exact.
struct MeshStiffnessErrors {
  double sun_planet = 0, ring_planet = 0;
  ErrorParts sun_parts{}, ring_parts{};  ///< of them, where known
  double ring_mode = 0;                  ///< relative error of the frequencies of the elastic ring
  ErrorParts ring_mode_parts{};          ///< of it
};
[[nodiscard]] MeshStiffnessErrors stiffness_errors(const MeshResult& sun_mesh, const MeshResult& ring_mesh);

/// The error of a frequency is that of the stiffnesses times half their shares of the strain energy of the mode, and
/// that of the ring's own frequencies times the share of its elasticity (ring_mode, ring_body); all taken to err the
/// same way.
[[nodiscard]] StageModes stage_modes(const dynamics::PlanetaryStage& stage, const MeshStiffnessErrors& errors);

/// The distinct natural frequencies above zero with their errors, by the keys of dynamics::planetary_figures.
[[nodiscard]] FigureSet frequency_figures(const StageModes& modes);

/// The text of modes.csv without its header lines.
[[nodiscard]] std::string modes_csv(const StageModes& modes);

}  // namespace annulus::app
