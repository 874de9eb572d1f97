#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/model/dynamics_members.h"
#include "app/model/run_options.h"
#include "app/results/cached_value.h"
#include "app/results/content_id.h"
#include "app/study/studies.h"
#include "app/study/study_points.h"
#include "core/errors.h"
#include "core/log.h"
#include "core/parallel.h"

namespace annulus {

ANNULUS_MEMBERS(dynamics::TransientResponse, meshes, gears, nominal, time, speed, torque, largest, smallest, mean, open,
                open_error, between_samples, settling_cycles, settled, spectrum_of, order, window_time, window_speed,
                amplitude, other_loads, without_sticking, statistics);
ANNULUS_MEMBERS(app::VariantCourse, response, figures, failure);

namespace app {

namespace {

constexpr double tolerance = 1e-6;

dynamics::TransientResponse at_tolerance(const TransientInput& input, const LumpedModel& model, double relative) {
  dynamics::TransientOptions options;
  options.course = input.course();
  options.accelerated_by = input.accelerated_by;
  options.integrator.relative_tolerance = relative;
  return dynamics::follow_course(model.lumped(), options);
}

VariantCourse followed(const StudySubject& subject, const TransientInput& input, std::size_t variant,
                       const LumpedModel& model) {
  VariantCourse course{at_tolerance(input, model, tolerance)};
  const auto looser = at_tolerance(input, model, 10 * tolerance);
  course.figures = subject.with_errors(
      variant, dynamics::figures(course.response, looser),
      [&](const LumpedModel& changed) { return dynamics::figures(at_tolerance(input, changed, tolerance)); });
  return course;
}

Csv cycles_table(const dynamics::TransientResponse& r) {
  Csv csv;
  csv.columns = {"mesh_cycle", "time_s", "speed_factor", "torque_factor"};
  for (const auto& mesh : r.meshes)
    for (const auto* what : {"_max_N", "_min_N", "_mean_N"}) csv.columns.push_back(mesh + what);
  for (Eigen::Index c = 0; c < r.time.size(); ++c) {
    auto& row = csv.rows.emplace_back(std::vector{static_cast<double>(c), r.time[c], r.speed[c], r.torque[c]});
    for (Eigen::Index m = 0; m < r.largest.rows(); ++m)
      row.insert(row.end(), {r.largest(m, c), r.smallest(m, c), r.mean(m, c)});
  }
  csv.round();
  return csv;
}

/// A row per window, a column per order.
Csv waterfall_table(const dynamics::TransientResponse& r) {
  Csv csv;
  csv.columns = {"time_s", "speed_factor"};
  for (Eigen::Index i = 0; i < r.order.size(); ++i) csv.columns.push_back(fmt::format("order_{:g}_N", r.order[i]));
  for (Eigen::Index w = 0; w < r.window_time.size(); ++w) {
    auto& row = csv.rows.emplace_back(std::vector{r.window_time[w], r.window_speed[w]});
    row.insert(row.end(), r.amplitude.col(w).begin(), r.amplitude.col(w).end());
  }
  csv.round();
  return csv;
}

void write(const VariantCourse& course, const std::filesystem::path& folder, std::size_t number) {
  const auto& r = course.response;
  auto cycles = cycles_table(r);
  cycles.header = {{"annulus_version", version()},
                   {"cycles", fmt::format("of the mesh; below {0:g} of the speed of [stage] the time of one at {0:g}",
                                          dynamics::TransientOptions::slowest)}};
  cycles.write(folder / fmt::format("transient_{}.csv", number));
  auto waterfall = waterfall_table(r);
  waterfall.header = {{"annulus_version", version()},
                      {"mesh", r.meshes.at(static_cast<std::size_t>(r.spectrum_of))},
                      {"orders", "multiples of the mesh frequency, amplitudes"}};
  waterfall.write(folder / fmt::format("transient_{}_waterfall.csv", number));
}

}  // namespace

std::vector<std::string> TransientResult::warnings(std::size_t variant) const {
  std::vector<std::string> list;
  const auto& response = variants.at(variant).response;
  if (!response.settled.value_or(true))
    list.push_back(
        fmt::format("the motion at the first speed and torque had not settled after {} mesh cycles; begin the course "
                    "with a longer part in which they stay as they are",
                    response.settling_cycles));
  if (response.other_loads && !input.torque.empty())
    list.emplace_back(
        "weights, torque ripples and what bearings bear at the torque of [stage] keep their size while the torque "
        "changes");
  if (response.without_sticking)
    list.push_back(fmt::format(
        "friction falls to nothing below {:g} of the speed of [stage]: teeth at rest do not stick, and what "
        "friction could hold there moves",
        dynamics::Pacing::slipping));
  return list;
}

TransientResult followed_transient(const StudySubject& subject, std::size_t number) {
  const auto& input = subject.scene().transients.at(number);
  TransientResult result{input, std::vector<VariantCourse>(subject.variants().size())};
  for_each_task(result.variants.size(), subject.options().threads, [&](std::size_t variant) {
    auto& course = result.variants[variant];
    try {
      const auto model = subject.model({{}, fmt::format("[[transient]] '{}'", input.name), ""}, variant);
      const auto id = identity_of(std::string("transient 3"), model->id(), input.time, input.speed, input.torque,
                                  static_cast<int>(input.accelerated_by), tolerance);
      const auto [found, reused] = cached_value(subject.options().store.get(), "transients", id,
                                                [&] { return followed(subject, input, variant, *model); });
      course = found;
      count_reuse(subject.options(), study_responses, reused ? 1 : 0, reused ? 0 : 1);
    } catch (const Error& error) {
      course.failure = error.what();
    }
  });
  return result;
}

TransientResult run_transient(const StudySubject& subject, std::size_t number) {
  auto result = followed_transient(subject, number);
  const auto& input = result.input;
  for (std::size_t variant = 0; variant < result.variants.size(); ++variant) {
    const auto& course = result.variants[variant];
    const auto name = fmt::format("[[transient]] '{}'{}", input.name, variant_words(subject, variant));
    if (!course.failure.empty()) {
      log::warn(fmt::format("{}: {}", name, course.failure));
      continue;
    }
    for (const auto& warning : result.warnings(variant)) log::warn(name + ": " + warning);
    write(course, subject.folder(variant), number + 1);
    log::info(fmt::format("{}: {} mesh cycles, {} steps", name, course.response.time.size(),
                          course.response.statistics.steps));
  }
  return result;
}

}  // namespace app

}  // namespace annulus
