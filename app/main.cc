#include <signal.h>

#include "app/cli.h"

namespace {

/// Before any library starts threads: none of them is to take the signals that interruption.h waits for. OpenBLAS
/// starts its own as it is loaded, before main() and before all constructors of this program.
void hold_signals_back(int, char**, char**) {
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGINT);
  ::sigaddset(&signals, SIGTERM);
  ::sigprocmask(SIG_BLOCK, &signals, nullptr);
}

[[gnu::section(".preinit_array"), gnu::used]] void (*const run_before_libraries)(int, char**,
                                                                                 char**) = hold_signals_back;

}  // namespace

int main(int argc, char** argv) { return annulus::app::run_command_line(argc, argv); }
