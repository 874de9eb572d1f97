#pragma once

#include <vector>

#include "dynamics/figures/poincare_point.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::dynamics {

/// Root mean square about the mean and peak to peak of a motion over the window, m.
struct MotionRange {
  double rms = 0, peak_to_peak = 0;
};

/// Largest values over the planets of one kind of mesh.
struct KindFigures {
  double instantaneous = 0, averaged = 0, quasi_static = 0;  ///< load sharing
  double dynamic_factor = 0;
  double contact_loss = 0;  ///< fraction of the time
};

/// Results of one response that a study (sweep, sensitivity, Monte Carlo) stores.
struct PointFigures {
  KindFigures sun_planet, ring_planet;
  bool steady = false;
  int window_cycles = 0;
  // Only with PointOptions::motion:
  /// Distance of the sun's centre from its mean position; peak to peak: the larger one of x and y. NaN when rigid.
  MotionRange sun{};
  MotionRange sun_mesh{}, ring_mesh{};    ///< deflection of the mesh that moves most
  std::vector<double> frequencies{};      ///< Hz, the lowest distinct natural frequencies above zero
  std::vector<PoincarePoint> poincare{};  ///< one per mesh cycle of the window, `poincare_cycles` at most
};

/// Natural frequencies among the results of a planetary stage.
inline constexpr int planetary_frequencies = 6;

struct PointOptions {
  SimulationOptions simulation;
  bool motion = true;         ///< orbits, deflections, natural frequencies and Poincare points too
  int poincare_cycles = 200;  ///< at most
};

/// Response and results of one stage. Throws what `simulate` and `modes` throw.
[[nodiscard]] PointFigures evaluate_point(const PlanetaryStage& stage, const PointOptions& options);

/// Method and version of the responses of studies; part of the identity of stored results.
[[nodiscard]] const char* point_method();

}  // namespace annulus::dynamics
