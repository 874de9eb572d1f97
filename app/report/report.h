#pragma once

#include "app/stage/planetary_run.h"
#include "app/report/page.h"

namespace annulus::app {

/// report.html of a planetary stage.
[[nodiscard]] Page stage_report(const RunResult& result);

}  // namespace annulus::app
