#pragma once

#include "app/pair/pair_run.h"

namespace annulus::app {

/// Adds to every figure's error what the error of the stiffness table can do to it, as carried_errors.h does for
/// planetary stages: the pair is solved again by harmonic balance on tables changed within their own uncertainty and
/// compared with the unchanged one found the same way. Added are the larger difference of a stiffer and of a more
/// rippled table, and a third of the difference to every second phase. NaN where a changed table gives no response.
/// Nothing is added for a stiffness that is not tabulated; where the table has no error estimate, only the part of the
/// phases.
void add_table_errors(const PairRunResult& result, dynamics::PairResponse& response);

}  // namespace annulus::app
