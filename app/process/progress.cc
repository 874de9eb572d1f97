#include "app/process/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

#include "app/process/held_limits.h"
#include "core/log.h"
#include "core/not_known.h"

namespace annulus::app {

namespace {
std::atomic<bool> progress_shown = true;
}

void show_progress(bool show) { progress_shown = show; }

double time_left(double fraction, double passed, double predicted) {
  const bool known = predicted > 0;  // false for NaN
  if (fraction >= 1) return 0;
  if (fraction <= 0) return known ? std::max(0.0, predicted - passed) : not_known;
  const double by_fraction = passed * (1 - fraction) / fraction;
  if (!known) return by_fraction;
  return fraction * by_fraction + (1 - fraction) * std::max(0.0, predicted - passed);
}

Progress::Progress(std::string label, double predicted)
    : label_(std::move(label)),
      predicted_(predicted),
      start_(std::chrono::steady_clock::now()),
      last_(start_ - std::chrono::seconds(1)),  // the first one is drawn
      terminal_(::isatty(STDERR_FILENO) != 0) {
  set_running_step(label_);
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
  fraction = std::clamp(fraction, 0.0, 1.0);
  const double passed = std::chrono::duration<double>(now - start_).count();
  const int filled = static_cast<int>(fraction * 30);
  const double left = time_left(fraction, passed, predicted_);
  fmt::print(stderr, "\r\x1b[K{} [{:#<{}}{:.<{}}] {:3.0f} %{}", label_, "", filled, "", 30 - filled, 100 * fraction,
             std::isfinite(left) ? fmt::format(", {:.0f} s left", left) : "");
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::finish(const std::string& result) {
  clear_line();
  log::info(label_ + ": " + result);
}

}  // namespace annulus::app
