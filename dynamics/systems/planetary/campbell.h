#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/systems/planetary/planetary_modes.h"

namespace annulus::dynamics {

struct CampbellOptions {
  int orders = 5;  ///< mesh orders 1 ... whose crossings are listed
  ModeDamping damping = ModeDamping::undamped;
};

/// One natural frequency over the speeds, followed by the modal assurance criterion (MAC) [AllemangBrown1982] of its
/// shape.
struct CampbellCurve {
  ModeKind kind = ModeKind::mixed;  ///< at the first speed above zero
  std::vector<double> frequency;    ///< Hz, one per speed
  std::vector<double> damping_ratio;
  /// Modal assurance criterion between the shapes at this speed and the one before (1 at the first).
  std::vector<double> mac;
};

/// Speed at which a mesh order equals a natural frequency.
struct CriticalSpeed {
  int curve = 0;         ///< index into `Campbell::curves`
  int order = 0;         ///< multiple of the mesh frequency
  double speed = 0;      ///< rad/s, of the carrier against the ring, between two speeds by linear interpolation
  double frequency = 0;  ///< Hz
  /// |sum of phi^H b_n e^(-2 pi i order lag_n)| / sum |phi^H b_n|, the larger of sun and ring meshes. 0: the phases of
  /// the meshes prevent this order from exciting the mode [ParkerLin2004], or the mode whirls against it. 1: all meshes
  /// excite it together. For modes of one frequency: their combination that is excited most. Errors of the gears excite
  /// beyond it.
  double participation = 0;
};

/// The modes at rest without dampers, each followed by its shape to the carrier speed of the stage, dampers included.
[[nodiscard]] std::vector<RotatingMode> modes_at_speed(const PlanetaryStage& stage);

struct Campbell {
  std::vector<double> speeds;            ///< carrier against ring, rad/s
  std::vector<double> mesh_frequency;    ///< Hz, one per speed, seen from the carrier; order h is h times it
  std::vector<CampbellCurve> curves;     ///< rising frequency at the first speed
  std::vector<CriticalSpeed> crossings;  ///< rising speed
};

/// Natural frequencies in the carrier frame over rising speeds (rad/s) of the carrier against the ring; all members
/// keep the proportions of their speeds (the ring stands still where those of the stage are zero). Curves may cross.
/// Where two of one kind veer, the shapes decide, so the steps must be finer than the veering. Throws InputError for
/// speeds that do not rise or are negative, and what `rotating_modes` throws.
[[nodiscard]] Campbell campbell(const PlanetaryStage& stage, const std::vector<double>& speeds,
                                const CampbellOptions& options = {});

}  // namespace annulus::dynamics
