#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/figure.h"

namespace annulus::app {

/// One way to make and solve a lumped model, as the cost study measures it.
struct ModelWay {
  std::string fidelity{};      ///< "harmonic balance", "time integration", "shooting", "coupling"; empty: as in a run
  std::string settings{};      ///< "64 samples per mesh cycle", "sun held in place"
  std::string id{};            ///< identity of everything the results depend on
  bool finest = false;         ///< the others are compared with it
  bool changes_model = false;  ///< its error is not one of numbers
  /// The results, with the errors that the program states. Throws when there is no periodic motion.
  std::function<FigureSet()> figures{};
};

/// All ways to a lumped model on some tables.
struct ModelWays {
  ModelWay as_run{};  ///< with the errors of the tables; without `figures`: its LumpedModel with propagated errors
  std::vector<ModelWay> others{};
};

}  // namespace annulus::app
