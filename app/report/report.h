#pragma once

#include <string>

#include "app/stage/planetary_run.h"

namespace annulus::app {

/// report.html: one self-contained page without external references.
[[nodiscard]] std::string report_html(const RunResult& result);

}  // namespace annulus::app
