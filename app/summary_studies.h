#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/pipeline.h"

namespace annulus::app {

/// Adds "monte_carlo" and "sweeps" to the entry of one ring of summary.json.
void add_ring_studies(nlohmann::ordered_json& ring, const RunResult& result, std::size_t index);
/// Adds "monte_carlo" (orders of the rings) and "sensitivity" to summary.json.
void add_studies(nlohmann::ordered_json& json, const RunResult& result);

}  // namespace annulus::app
