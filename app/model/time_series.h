#pragma once

#include "core/csv.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::app {

/// All motions (m) and forces (N) over the time (s), by the names of their DOFs and meshes, each `stride`-th sample.
[[nodiscard]] Csv time_series_table(const dynamics::TimeSeries& series, int stride = 1);

}  // namespace annulus::app
