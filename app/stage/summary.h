#pragma once

#include <string>

#include "app/pipeline.h"

namespace annulus::app {

/// summary.json: every figure of merit with its error estimate; a stable interface.
[[nodiscard]] std::string summary_json(const RunResult& result);
/// The short text for standard output.
[[nodiscard]] std::string summary_text(const RunResult& result);

}  // namespace annulus::app
