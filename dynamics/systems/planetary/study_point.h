#pragma once

#include <vector>

#include "core/figure.h"
#include "dynamics/figures/motion.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::dynamics {

/// Results of one response that a study (sweep, sensitivity, Monte Carlo) stores.
struct PointFigures {
  /// By the keys of planetary_figures: those of effort `forces`, with PointOptions::motion also those of effort
  /// `motion`. Motion of the sun: NaN when it is rigid.
  FigureSet figures;
  int window_cycles = 0;
  SystemState end{};                      ///< of the window
  std::vector<PoincarePoint> poincare{};  ///< with motion: one per mesh cycle of the window, `poincare_cycles` at most
};

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
