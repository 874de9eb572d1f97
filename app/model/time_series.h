#pragma once

#include "core/csv.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::app {

/// Mesh cycles of a window that are written. A ring on pins repeats after more than a thousand of them, whose spectrum
/// and results contain them all.
inline constexpr int written_cycles = 200;

/// All motions (m) and forces (N) over the time (s), by the names of their DOFs and meshes: every sample of the first
/// `written_cycles`. A header line says how many of a longer window stand there.
[[nodiscard]] Csv time_series_table(const dynamics::TimeSeries& series, int window_cycles);

}  // namespace annulus::app
