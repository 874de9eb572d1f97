#include "app/process/held_limits.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "core/log.h"
#include "core/stopwatch.h"

namespace annulus::app {

namespace {

struct Held {
  HeldLimits limits;
  Stopwatch stopwatch{};
};

/// Never destroyed: the thread that asks goes on while the process ends.
struct State {
  std::mutex lock;
  std::shared_ptr<const Held> held;
  std::string running_step;
};

State& state() {
  static auto* const all = new State;
  return *all;
}

/// The thread that asks never waits: a process may be forked while another one holds the lock.
std::shared_ptr<const Held> held_now() {
  auto& s = state();
  const std::unique_lock guard(s.lock, std::try_to_lock);
  return guard ? s.held : nullptr;
}

double memory_of_measured_MB() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 * 1e-6;
}

std::string what_remains(const Held& h) {
  return "finished results are stored in " + h.limits.stored + " and reused by the next run";
}

}  // namespace

void hold_limits(const HeldLimits& limits) {
  auto& s = state();
  {
    const std::scoped_lock guard(s.lock);
    s.held = std::make_shared<const Held>(Held{limits});
  }
  if (const auto exceeded = exceeded_limit(); !exceeded.empty()) throw LimitError(exceeded);
}

void check_held_memory(double predicted_MB, const std::string& step, const std::string& remedy) {
  auto& s = state();
  std::shared_ptr<const Held> h;
  {
    const std::scoped_lock guard(s.lock);
    h = s.held;
  }
  if (!h || !(predicted_MB > h->limits.memory_MB)) return;
  throw LimitError(fmt::format(
      "--max-memory: ended before {}: predicted to need {:.0f} MB, the limit is {:.0f} MB; {}; {}, or raise the limit",
      step, predicted_MB, h->limits.memory_MB, what_remains(*h), remedy));
}

void set_running_step(const std::string& label) {
  auto& s = state();
  const std::scoped_lock guard(s.lock);
  s.running_step = label;
}

std::string exceeded_limit() {
  const auto h = held_now();
  if (!h) return "";
  const double seconds = h->stopwatch.seconds();
  const double memory = std::max(peak_memory_MB(), memory_of_measured_MB());
  const bool too_large = memory > h->limits.memory_MB;
  if (!too_large && seconds <= h->limits.seconds) return "";
  std::string step = "the run";
  auto& s = state();
  if (const std::unique_lock guard(s.lock, std::try_to_lock); guard && !s.running_step.empty()) step = s.running_step;
  const auto reached =
      too_large ? fmt::format("--max-memory: ended during {}: {:.0f} MB in use after {:.1f} s, the limit is {:.0f} MB",
                              step, memory, seconds, h->limits.memory_MB)
                : fmt::format("--max-time: ended during {} after {:.1f} s, the limit is {:.6g} s", step, seconds,
                              h->limits.seconds);
  return fmt::format("{}; {}; ask for less accuracy (accuracy){}, or raise the limit", reached, what_remains(*h),
                     too_large ? " or fewer threads (--threads)" : "");
}

}  // namespace annulus::app
