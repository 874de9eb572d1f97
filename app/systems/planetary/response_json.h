#pragma once

#include <string>

#include "app/systems/planetary/stage_response.h"

namespace annulus::app {

/// figures.json: figures of merit and modes of one response, with the identity of its inputs.
[[nodiscard]] std::string response_json(const StageResponse& response, const std::string& id);

}  // namespace annulus::app
