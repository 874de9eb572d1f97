#pragma once

#include <string>
#include <vector>

#include "dynamics/optimisation/optimise.h"

namespace annulus::app {

/// As in the scene: "genetic", "cma_es", "differential_evolution".
[[nodiscard]] const std::vector<std::string>& optimiser_names();
/// Of one of these names.
[[nodiscard]] dynamics::Optimiser optimiser_of(const std::string& name);

}  // namespace annulus::app
