#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>

#include "core/log.h"

namespace annulus::app {

namespace {
std::atomic<bool> progress_shown = true;
}

void show_progress(bool show) { progress_shown = show; }

Progress::Progress(std::string label)
    : label_(std::move(label)),
      start_(std::chrono::steady_clock::now()),
      last_(start_),
      terminal_(::isatty(STDERR_FILENO) != 0) {
  if (!terminal_) log::info(label_ + " ...");
}

Progress::~Progress() { clear_line(); }

void Progress::clear_line() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
  drawn_ = false;
}

void Progress::update(double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || !progress_shown || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const double passed = std::chrono::duration<double>(now - start_).count();
  const int filled = static_cast<int>(fraction * 30);
  fmt::print(stderr, "\r\x1b[K{} [{:#<{}}{:.<{}}] {:3.0f} %, {:.0f} s left", label_, "", filled, "", 30 - filled,
             100 * fraction, fraction > 0 ? passed * (1 - fraction) / fraction : 0);
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::finish(const std::string& result) {
  clear_line();
  log::info(label_ + ": " + result);
}

}  // namespace annulus::app
