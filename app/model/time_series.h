#pragma once

#include "core/csv.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::app {

/// How many samples of a series are written: those of the first `dynamics::long_window` mesh cycles. A ring on pins
/// repeats after more than a thousand of them, whose spectrum and results contain them all. Adds a header line that
/// states this where the window is longer.
[[nodiscard]] Eigen::Index written_samples(const dynamics::TimeSeries& series, int window_cycles, Csv& csv);

/// All motions (m) and forces (N) over the time (s), by the names of their DOFs and meshes: the samples that are
/// written.
[[nodiscard]] Csv time_series_table(const dynamics::TimeSeries& series, int window_cycles);

}  // namespace annulus::app
