#pragma once

#include "app/report/page.h"
#include "app/systems/planetary/planetary_run.h"

namespace annulus::app {

/// report.html of a planetary stage.
[[nodiscard]] Page stage_report(const RunResult& result);

}  // namespace annulus::app
