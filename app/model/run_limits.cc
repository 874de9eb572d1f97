#include "app/model/run_limits.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>

#include "app/model/gear_system.h"
#include "app/model/plan_studies.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

constexpr double week = 7 * 24 * 3600.0;
constexpr double bytes_per_MB = 1e6;

/// The limit that a control group sets, if any; MB.
double group_memory_MB() {
  double least = std::numeric_limits<double>::infinity();
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    double bytes = 0;
    if (std::ifstream(file) >> bytes && bytes > 0) least = std::min(least, bytes / bytes_per_MB);
  }
  return least;
}

/// What a limit of the address space (ulimit -v) leaves; MB. Libraries and the buffers of OpenBLAS, which waits for
/// ever where it does not get them, are mapped but hardly used.
double address_space_MB() {
  constexpr double mapped = 800;
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return std::max(0.0, static_cast<double>(limit.rlim_cur) / bytes_per_MB - mapped);
}

/// Of all points of a study, which are kept until its report is written; MB. A search keeps its best ones only.
double study_MB(const Scene& scene, const StudyPlan& study) {
  if (study.name == "[optimise]") return 0;
  constexpr double of_a_point = 200;  // bytes besides its figures: vectors, a text
  const auto figures = static_cast<double>(system_kind(scene.stage.kind).model_figures().size());
  return static_cast<double>(study.responses) * (of_a_point + figures * sizeof(double)) / bytes_per_MB;
}

/// One part of a run, as far as limits go.
struct Need {
  std::string label;
  double seconds = 0, memory_MB = 0;
  std::string cure;
};

std::string mesh_cure(const CostStep& step) {
  return fmt::format(
      "its size follows from `accuracy` and `model` (here {}, {:.3g} unknowns per pair of sectors, {} ring "
      "positions)",
      step.size.kind, step.size.unknowns, step.size.cycles);
}

std::vector<Need> needs_of(const Scene& scene, int threads, const CostModel& costs, bool with_dynamics) {
  std::vector<Need> needs;
  for (const auto& step : make_system(scene)->cost(threads, costs).steps) {
    const bool solved = step.kind == CostKind::mesh || step.kind == CostKind::coupling;
    if (step.kind == CostKind::studies || (!solved && !with_dynamics)) continue;
    needs.push_back({step.label, step.predicted.seconds, step.predicted.peak_MB,
                     solved                        ? mesh_cure(step)
                     : scene.dynamics->mesh_cycles ? "it follows from dynamics.mesh_cycles"
                                                   : "it follows from the period of the errors; dynamics.mesh_cycles "
                                                     "sets how long is integrated"});
  }
  if (!with_dynamics) return needs;
  double longest_table = 0;
  for (const auto& need : needs)
    if (std::isfinite(need.seconds)) longest_table = std::max(longest_table, need.seconds);
  for (const auto& study : plan_studies(scene))
    needs.push_back({study.name, study.seconds / threads + study.tables * longest_table, study_MB(scene, study),
                     fmt::format("it asks for {} responses{}", study.responses,
                                 study.tables ? fmt::format(" and {} tables", study.tables) : "")});
  return needs;
}

std::string gigabytes(double MB) { return MB < 1e3 ? memory_text(MB) : fmt::format("{:.3g} GB", MB / 1e3); }

}  // namespace

RunLimits RunLimits::of_this_machine() {
  const double physical =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / bytes_per_MB;
  return {std::min({physical, group_memory_MB(), address_space_MB()}), week};
}

double parse_memory(const std::string& text) {
  static constexpr std::pair<const char*, double> memory_units[] = {{"MB", 1}, {"GB", 1e3}, {"TB", 1e6}};
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && std::isfinite(value) && value > 0) {
    std::string unit(end, text.data() + text.size());
    unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
    for (const auto& [name, MB] : memory_units)
      if (unit == name) return value * MB;
  }
  throw InputError(
      fmt::format("--max-memory {}: is not an amount of memory above zero; write 800MB, 16GB or 1TB", text));
}

void check_limits(const Scene& scene, const RunLimits& limits, int threads, const CostModel& costs,
                  bool with_dynamics) {
  const auto needs = needs_of(scene, threads, costs, with_dynamics);
  double seconds = 0;
  const Need *longest = nullptr, *largest = nullptr;
  for (const auto& need : needs) {
    if (std::isfinite(need.seconds)) {
      seconds += need.seconds;
      if (!longest || need.seconds > longest->seconds) longest = &need;
    }
    if (std::isfinite(need.memory_MB) && (!largest || need.memory_MB > largest->memory_MB)) largest = &need;
  }
  if (largest && largest->memory_MB > limits.memory_MB)
    throw SolverError(
        fmt::format("{}: refused: predicted to need {} of memory, the limit is {} (--max-memory); most goes "
                    "into the {}: {}",
                    scene.file.string(), gigabytes(largest->memory_MB), gigabytes(limits.memory_MB), largest->label,
                    largest->cure));
  if (longest && seconds > limits.seconds)
    throw SolverError(
        fmt::format("{}: refused: predicted to take {}, the limit is {} (--max-time); {} of it go into the "
                    "{}: {}",
                    scene.file.string(), duration_text(seconds), duration_text(limits.seconds),
                    duration_text(longest->seconds), longest->label, longest->cure));
}

}  // namespace annulus::app
