#include "core/log.h"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <sstream>

namespace annulus::log {

namespace {

std::ostringstream& record() {
  static std::ostringstream text;
  return text;
}

// Made on first use, so that static initialisation order does not matter; with the record the only global of annulus.
spdlog::logger& logger() {
  static const auto instance = [] {
    // Coloured on a terminal only, and not where the user wants none (no-color.org).
    const char* no_colour = std::getenv("NO_COLOR");
    const bool plain = no_colour != nullptr && *no_colour != '\0';
    auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>(plain ? spdlog::color_mode::never
                                                                            : spdlog::color_mode::automatic);
    for (const auto level : {spdlog::level::info, spdlog::level::debug}) sink->set_color(level, sink->reset);
    sink->set_color(spdlog::level::warn, sink->yellow);
    sink->set_color(spdlog::level::err, sink->red);
    const auto kept = std::make_shared<spdlog::sinks::ostream_sink_mt>(record());
    auto made = std::make_shared<spdlog::logger>("annulus", spdlog::sinks_init_list{sink, kept});
    made->set_pattern("%^%v%$");
    made->set_level(spdlog::level::info);
    made->flush_on(spdlog::level::info);
    return made;
  }();
  return *instance;
}

}  // namespace

void set_level(Level level) {
  switch (level) {
    case Level::quiet:
      logger().set_level(spdlog::level::warn);
      break;
    case Level::normal:
      logger().set_level(spdlog::level::info);
      break;
    case Level::verbose:
      logger().set_level(spdlog::level::debug);
      break;
  }
}

// The message is an argument, not the format: braces in it stay as they are.
void info(const std::string& message) { logger().info("{}", message); }
void debug(const std::string& message) { logger().debug("{}", message); }
void error(const std::string& message) { logger().error("{}", message); }
void warn(const std::string& message) { logger().warn("warning: {}", message); }
std::string recorded() { return record().str(); }

}  // namespace annulus::log

namespace annulus {

StageTimers::Scope::Scope(StageTimers& timers, std::string stage) : timers_(timers), stage_(std::move(stage)) {
  auto& stages = timers_.stages_;
  if (std::none_of(stages.begin(), stages.end(), [&](const auto& s) { return s.first == stage_; }))
    stages.emplace_back(stage_, 0.0);  // at entry, so that the report is in order of entry
  ++timers_.open_;
}

StageTimers::Scope::~Scope() {
  const double elapsed = watch_.seconds();
  for (auto& [name, seconds] : timers_.stages_)
    if (name == stage_) seconds += elapsed;
  if (--timers_.open_ == 0) timers_.covered_ += elapsed;
}

double StageTimers::seconds(const std::string& stage) const {
  for (const auto& [name, seconds] : stages_)
    if (name == stage) return seconds;
  return 0;
}

std::vector<std::pair<std::string, double>> StageTimers::report() const {
  auto rows = stages_;
  const double total = watch_.seconds();
  rows.emplace_back("other", total - covered_);
  rows.emplace_back("total", total);
  return rows;
}

double peak_memory_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 * 1e-6;  // Linux counts kibibytes
}

}  // namespace annulus
