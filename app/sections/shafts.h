#pragma once

#include <vector>

#include "app/model/system_run.h"
#include "app/report/section.h"
#include "core/json.h"
#include "dynamics/figures/shaft_results.h"

namespace annulus::app {

/// For the summary.
[[nodiscard]] Json to_json(const std::vector<dynamics::ShaftResult>& shafts);
/// What the shafts of the rotors carry.
[[nodiscard]] Section shafts_section(const SystemRun& run);

}  // namespace annulus::app
