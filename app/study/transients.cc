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
                amplitude, statistics);
ANNULUS_MEMBERS(app::VariantCourse, response, largest_force, largest_over_nominal, contact_loss, shaft_torque,
                other_loads, failure);

namespace app {

namespace {

constexpr double tolerance = 1e-6;

dynamics::TransientOptions options_of(const TransientInput& input, double relative_tolerance) {
  dynamics::TransientOptions options;
  for (std::size_t i = 0; i < input.time.size(); ++i)
    options.course.points.push_back({input.time[i], input.factor_of_speed(i), input.factor_of_torque(i)});
  options.accelerated_by = input.turned_by == TransientInput::Inertia::drive ? dynamics::AcceleratedBy::drive
                                                                             : dynamics::AcceleratedBy::load;
  options.integrator.relative_tolerance = relative_tolerance;
  return options;
}

constexpr const char *force_key = "largest_force", *factor_key = "largest_over_nominal";
std::string loss_key(int mesh) { return fmt::format("contact_loss_{}", mesh); }
std::string shaft_key(int mesh) { return fmt::format("shaft_torque_{}", mesh); }

double ratio(double value, double nominal) { return nominal == 0 ? not_known : value / std::abs(nominal); }

FigureSet figures_of(const dynamics::TransientResponse& r) {
  FigureSet figures;
  const auto peak = r.peak();
  figures.set(force_key, {std::abs(peak.force), 0});
  figures.set(factor_key, {ratio(std::abs(peak.force), r.nominal[peak.mesh]), 0});
  for (int m = 0; m < r.gears; ++m) figures.set(loss_key(m), {r.open[m], 0});
  for (int m = r.gears; m < static_cast<int>(r.meshes.size()); ++m)
    figures.set(shaft_key(m), {ratio(r.largest_of(m), r.nominal[m]), 0});
  return figures;
}

/// With the change by a tolerance ten times looser, and of largest values that by half the samples, as errors.
FigureSet with_integration_errors(const dynamics::TransientResponse& r, const dynamics::TransientResponse& other) {
  auto figures = figures_of(r);
  const auto known = figures, looser = figures_of(other);
  const auto add = [&](const std::string& key, double beside) {
    const double value = known.value(key);
    figures.set(key, {value, std::abs(value - looser.value(key)) + beside * value});
  };
  const double of_peak = r.between_samples[r.peak().mesh];
  add(force_key, of_peak);
  add(factor_key, of_peak);
  for (int m = 0; m < r.gears; ++m)
    figures.set(loss_key(m), {r.open[m], std::abs(r.open[m] - other.open[m]) + r.open_error[m]});
  for (int m = r.gears; m < static_cast<int>(r.meshes.size()); ++m) add(shaft_key(m), r.between_samples[m]);
  return figures;
}

VariantCourse followed(const StudySubject& subject, const TransientInput& input, std::size_t variant) {
  VariantCourse course;
  const auto at_tolerance = [&](const LumpedModel& model, double relative) {
    return dynamics::follow_course(model.lumped(), options_of(input, relative));
  };
  const auto model = subject.model({{}, fmt::format("[[transient]] '{}'", input.name), ""}, variant);
  course.response = at_tolerance(*model, tolerance);
  const auto system = model->lumped().system;
  course.other_loads = system.load(dynamics::LoadCause::none).any() || !system.harmonic_loads().empty();
  const auto& r = course.response;
  const auto nominal = with_integration_errors(r, at_tolerance(*model, 10 * tolerance));
  const auto figures = subject.with_errors(
      variant, nominal, [&](const LumpedModel& changed) { return figures_of(at_tolerance(changed, tolerance)); });
  course.largest_force = figures.figure(force_key);
  course.largest_over_nominal = figures.figure(factor_key);
  for (int m = 0; m < r.gears; ++m) course.contact_loss.push_back(figures.figure(loss_key(m)));
  for (int m = r.gears; m < static_cast<int>(r.meshes.size()); ++m)
    course.shaft_torque.push_back(figures.figure(shaft_key(m)));
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
  cycles.header = {{"annulus_version", version()}};
  cycles.write(folder / fmt::format("transient_{}.csv", number));
  auto waterfall = waterfall_table(r);
  waterfall.header = {{"annulus_version", version()},
                      {"mesh", r.meshes.at(static_cast<std::size_t>(r.spectrum_of))},
                      {"orders", "multiples of the mesh frequency, amplitudes"}};
  waterfall.write(folder / fmt::format("transient_{}_waterfall.csv", number));
}

}  // namespace

TransientResult run_transient(const StudySubject& subject, std::size_t number) {
  const auto& input = subject.scene().transients.at(number);
  TransientResult result{input, std::vector<VariantCourse>(subject.variants().size())};
  for_each_task(result.variants.size(), subject.options().threads, [&](std::size_t variant) {
    auto& course = result.variants[variant];
    try {
      const auto model = subject.model({{}, fmt::format("[[transient]] '{}'", input.name), ""}, variant);
      const auto id = identity_of(std::string("transient 1"), model->id(), input.time, input.speed, input.torque,
                                  input.turned_by == TransientInput::Inertia::drive ? 0 : 1, tolerance);
      const auto [found, reused] = cached_value(subject.options().store.get(), "transients", id,
                                                [&] { return followed(subject, input, variant); });
      course = found;
      count_reuse(subject.options(), study_responses, reused ? 1 : 0, reused ? 0 : 1);
    } catch (const Error& error) {
      course.failure = error.what();
    }
  });
  for (std::size_t variant = 0; variant < result.variants.size(); ++variant) {
    const auto& course = result.variants[variant];
    const auto name = fmt::format("[[transient]] '{}'{}", input.name, ring_words(subject, variant));
    if (!course.failure.empty()) {
      log::warn(fmt::format("{}: {}", name, course.failure));
      continue;
    }
    if (!course.response.settled.value_or(true))
      log::warn(
          fmt::format("{}: the motion at the first speed and torque had not settled after {} mesh cycles; begin "
                      "the course with a longer part in which they stay as they are",
                      name, course.response.settling_cycles));
    if (course.other_loads && !input.torque.empty())
      log::warn(
          fmt::format("{}: weights, torque ripples and what bearings bear at the torque of [stage] keep their size "
                      "while the torque changes",
                      name));
    write(course, subject.folder(variant), number + 1);
    log::info(fmt::format("{}: {} mesh cycles, {} steps", name, course.response.time.size(),
                          course.response.statistics.steps));
  }
  return result;
}

}  // namespace app

}  // namespace annulus
