#pragma once

namespace annulus::app {

/// Runs the command line and returns the exit status: 0 done, 2 wrong scene or arguments, 3 computation refused or not
/// accurate enough, 4 ended by --max-memory or --max-time, 130 interrupted, 1 a defect of annulus itself.
int run_command_line(int argc, char** argv);

}  // namespace annulus::app
