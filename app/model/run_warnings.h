#pragma once

#include <vector>

#include "app/model/system_run.h"
#include "app/plan/warning.h"

namespace annulus::app {

/// Everything a user must know before trusting the results of a run, the severe ones first: what its scene says of
/// itself, and what the results say, for every kind of gear system.
[[nodiscard]] std::vector<Warning> run_warnings(const SystemRun& run);

}  // namespace annulus::app
