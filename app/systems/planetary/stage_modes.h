#pragma once

#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "core/csv.h"
#include "core/figure.h"
#include "dynamics/modes/modal_energy.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::app {

/// The modes of one stage and what depends on its speed.
struct StageModes {
  struct Mode {
    double frequency = 0;        ///< Hz, undamped, at rest
    double frequency_error = 0;  ///< Hz, by the errors of the mesh stiffnesses
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

/// Relative errors of the mean tangents of the meshes and of the frequencies of the elastic ring.
using MeshStiffnessErrors = std::vector<dynamics::GroupError>;
[[nodiscard]] MeshStiffnessErrors stiffness_errors(const MeshResult& sun_mesh, const MeshResult& ring_mesh);

/// Modes with the errors of their frequencies, see dynamics::frequency_errors.
[[nodiscard]] StageModes stage_modes(const dynamics::PlanetaryStage& stage, const MeshStiffnessErrors& errors);

/// Adds to the model's part of every error what changes when `other` replaces the stage, with the same DOFs.
void add_model_change(StageModes& modes, const dynamics::PlanetaryStage& other);

/// The distinct natural frequencies above zero with their errors, by the keys of dynamics::planetary_figures.
[[nodiscard]] FigureSet frequency_figures(const StageModes& modes);

/// The text of modes.csv without its header lines.
[[nodiscard]] std::string modes_csv(const StageModes& modes);

}  // namespace annulus::app
