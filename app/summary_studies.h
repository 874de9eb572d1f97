#pragma once

#include <string>

#include "app/pipeline.h"

/// The studies as JSON objects (text), to be merged into summary.json.
namespace annulus::app {

/// "monte_carlo" and "sweeps" of one ring.
[[nodiscard]] std::string ring_studies_json(const RunResult& result, std::size_t ring);
/// "monte_carlo" (orders of the rings) and "sensitivity".
[[nodiscard]] std::string studies_json(const RunResult& result);

}  // namespace annulus::app
