#include "dynamics/transient/transient_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/not_known.h"
#include "dynamics/figures/common_figures.h"

namespace annulus::dynamics {

namespace {

constexpr const char *factor_key = "course_force_factor", *loss_key = "course_contact_loss",
                     *shaft_key = "course_shaft_torque";

double over_nominal(double value, double nominal) { return nominal == 0 ? not_known : value / std::abs(nominal); }

/// Adds the largest of the figures of some elements.
void add_largest(FigureSet& set, const char* key, int first, int end) {
  Figure most{not_known, not_known};
  for (int row = first; row < end; ++row)
    if (const auto figure = set.figure(course_element_key(row)); !(figure.value <= most.value)) most = figure;
  if (first < end) set.set(key, most);
}

}  // namespace

std::string course_element_key(int row) { return fmt::format("course_element_{}", row + 1); }

const std::vector<FigureSpec>& transient_figures() {
  static const std::vector<FigureSpec> list = {
      {.key = course_force_key,
       .title = "Largest mesh force of a course",
       .unit = "kN",
       .scale = 1e-3,
       .definition = "Largest force of any mesh of gears, by amount, while speed and torque follow a [[transient]].",
       .better = Better::smaller,
       .effort = FigureEffort::motion},
      {.key = factor_key,
       .title = "Largest mesh force of a course over the nominal one",
       .definition = "Largest force of any mesh of gears, by amount, while speed and torque follow a [[transient]], "
                     "over the mean "
                     "force of meshes of its kind under the torque of [stage].",
       .term = "peak_factor",
       .better = Better::smaller,
       .effort = FigureEffort::motion},
      contact_loss_figure(loss_key, "Time without contact of a course, worst mesh", "",
                          "Largest over the meshes of gears of the time in which no tooth touches over the time of the "
                          "[[transient]]."),
      {.key = shaft_key,
       .title = "Largest torque of a shaft in a course",
       .definition = "Largest over the shafts of |torque| in the [[transient]] over the nominal torque; absent without "
                     "shafts.",
       .better = Better::smaller,
       .effort = FigureEffort::motion}};
  return list;
}

FigureSet figures(const TransientResponse& r) {
  FigureSet set;
  const auto peak = r.peak();
  set.set(course_force_key, {std::abs(peak.force), 0});
  set.set(factor_key, {over_nominal(std::abs(peak.force), r.nominal[peak.mesh]), 0});
  const auto rows = static_cast<int>(r.meshes.size());
  for (int row = 0; row < r.gears; ++row) set.set(course_element_key(row), {r.open[row], 0});
  for (int row = r.gears; row < rows; ++row)
    set.set(course_element_key(row), {over_nominal(r.largest_of(row), r.nominal[row]), 0});
  add_largest(set, loss_key, 0, r.gears);
  add_largest(set, shaft_key, r.gears, rows);
  return set;
}

FigureSet figures(const TransientResponse& r, const TransientResponse& looser) {
  auto set = figures(r);
  const auto others = figures(looser);
  const auto add_error = [&](const std::string& key, double beside) {
    const double value = set.value(key);
    set.set(key, {value, std::abs(value - others.value(key)) + beside});
  };
  const auto rows = static_cast<int>(r.meshes.size());
  for (const char* key : {course_force_key, factor_key})
    add_error(key, r.between_samples[r.peak().mesh] * set.value(key));
  for (int row = 0; row < rows; ++row) {
    const auto key = course_element_key(row);
    add_error(key, row < r.gears ? r.open_error[row] : r.between_samples[row] * set.value(key));
  }
  add_largest(set, loss_key, 0, r.gears);
  add_largest(set, shaft_key, r.gears, rows);
  return set;
}

}  // namespace annulus::dynamics
