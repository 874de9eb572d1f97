#include "app/model/scene_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "app/model/study_cases.h"
#include "core/units.h"

namespace annulus::app {

namespace {

void warn_of_assumptions(std::vector<Warning>& list, const Plan& plan) {
  std::vector<std::string> keys;
  for (const auto& input : plan.inputs)
    if (!input.assumed.empty() && std::find(keys.begin(), keys.end(), input.key) == keys.end())
      keys.push_back(input.key);
  if (keys.empty()) return;
  list.push_back({"assumed_inputs", Severity::note,
                  fmt::format("{} assumed; [assumed] states the reasons: {}. The results depend on them; "
                              "[sensitivity] shows how much",
                              keys.size() == 1 ? "1 input is" : fmt::format("{} inputs are", keys.size()),
                              fmt::join(keys, ", "))});
}

/// Empty where all are stated.
std::string text_of_unstated_phases(const Scene& scene) {
  const auto phases = unstated_phases(scene);
  if (phases.empty()) return "";
  std::set<std::string> keys;
  for (const auto& phase : phases) keys.insert(phase.substr(0, phase.find('[')));
  return fmt::format("the phases of {} errors are not stated ({})", phases.size(), fmt::join(keys, ", "));
}

void warn_of_phases(std::vector<Warning>& list, const Scene& scene) {
  const auto sampling = sampling_of(scene);
  if (!sampling) return warn_of_arbitrary_phases(list, scene, "state the phases, or draw samples");
  const auto what = text_of_unstated_phases(scene);
  if (what.empty() || !sampling->by_default) return;
  list.push_back(
      {"unstated_phases", Severity::note,
       what + fmt::format(
                  ": {} samples of them are drawn, and the result is their spread. State the phases if they are known",
                  sampling->samples)});
}

void warn_of_accuracy(std::vector<Warning>& list, const Scene& scene, const Plan& plan) {
  if (scene.fidelity == Fidelity::closed_form)
    list.push_back({"accuracy_not_controlled", Severity::warning,
                    "the error of the closed-form stiffness is not controlled, and the wanted accuracy is not checked; "
                    "model = \"plane\" controls it"});
  for (const auto& step : plan.cost.steps)
    if (step.kind == CostKind::mesh && std::isfinite(step.expected_error) && step.expected_error > scene.accuracy)
      list.push_back(
          {"accuracy_not_expected", Severity::warning,
           fmt::format("an error of {:.2g} % is expected, more than the wanted {:g} %; the run may be refused "
                       "at its end",
                       100 * step.expected_error, 100 * scene.accuracy),
           step.label});
}

}  // namespace

void warn_of_arbitrary_phases(std::vector<Warning>& list, const Scene& scene, const std::string& remedy) {
  const auto what = text_of_unstated_phases(scene);
  if (!what.empty())
    list.push_back(
        {"unstated_phases", Severity::warning, what + ". The results are those of one arbitrary choice; " + remedy});
}

std::vector<Warning> common_warnings(const Scene& scene, const Plan& plan) {
  std::vector<Warning> list;
  warn_of_accuracy(list, scene, plan);
  if (scene.dynamics) warn_of_phases(list, scene);
  warn_of_assumptions(list, plan);
  return list;
}

void warn_of_clearance(std::vector<Warning>& list, const geometry::GearPair& pair,
                       const std::pair<const char*, const char*>& gears, const std::string& mesh) {
  constexpr double least = 0.1;  // modules
  const double module = pair.pinion().parameters().module;
  const auto clearance = pair.tip_clearance();
  for (const auto& [gear, gap] : {std::pair{gears.first, clearance.pinion_tip}, {gears.second, clearance.wheel_tip}})
    if (gap < least * module)
      list.push_back(
          {"tip_clearance", Severity::warning,
           fmt::format("the tip of the {} passes the root of its mate with a clearance of {:.3g} mm, {:.2g} modules; "
                       "less than {:g} module leaves no room for lubricant, deflection and tolerances",
                       gear, gap / units::mm, gap / module, least),
           mesh});
}

void warn_of_undercut(std::vector<Warning>& list, const geometry::Gear& gear, const std::string& name) {
  if (!gear.undercut()) return;
  list.push_back(
      {"undercut", Severity::warning,
       fmt::format("the {} is undercut: its involute begins at a diameter of {} mm, above the base circle of "
                   "{} mm. Its mate does not use the missing part; the undercut tooth is weaker and softer, "
                   "as computed",
                   name, to_text(2 * gear.form_radius() / units::mm, 6),
                   to_text(2 * gear.base_radius() / units::mm, 6))});
}

void warn_of_measured_flanks(std::vector<Warning>& list, const geometry::GearPair& pair,
                             const std::pair<const char*, const char*>& gears, const std::string& mesh) {
  constexpr double most = 0.1;
  const double base = pair.pinion().base_radius(), wheel_base = pair.wheel().base_radius();
  const auto face = pair.common_face();
  const auto check = [&](const geometry::Gear& gear, const char* name, bool leading, double below,
                         std::pair<double, double> radii) {
    const auto& p = gear.parameters();
    const auto &side = leading ? p.leading_topography : p.trailing_topography,
               &other = leading ? p.trailing_topography : p.leading_topography;
    if (!side && other)
      list.push_back({"measured_flanks", Severity::warning,
                      fmt::format("the {} has a measured topography of the flanks that do not carry here; those that "
                                  "do are without deviations. Give both left_topography and right_topography",
                                  name),
                      mesh});
    if (!side) return;
    const auto [low, high] = std::minmax(radii.first, radii.second);
    const double missing = std::max(side->radii().front() - low, high - side->radii().back());
    if (missing > most * (high - low))
      list.push_back({"measured_flanks", Severity::warning,
                      fmt::format("the {} touches from diameter {} to {} mm, and its topography reaches from {} to {} "
                                  "mm: beyond its ends their values are used",
                                  name, to_text(2 * low / units::mm, 6), to_text(2 * high / units::mm, 6),
                                  to_text(2 * side->radii().front() / units::mm, 6),
                                  to_text(2 * side->radii().back() / units::mm, 6)),
                      mesh});
    if (side->positions().size() == 1) return;
    const double from = below - p.face_width / 2, to = from + face.width;
    if (std::max(side->positions().front() - from, to - side->positions().back()) > most * face.width)
      list.push_back({"measured_flanks", Severity::warning,
                      fmt::format("the {} touches from position {} to {} mm along its face, and its topography reaches "
                                  "from {} to {} mm: beyond its ends their values are used",
                                  name, to_text(from / units::mm, 5), to_text(to / units::mm, 5),
                                  to_text(side->positions().front() / units::mm, 5),
                                  to_text(side->positions().back() / units::mm, 5)),
                      mesh});
  };
  const double low = pair.roll_length_low(), high = pair.roll_length_high();
  check(pair.pinion(), gears.first, !pair.internal(), face.pinion.below,
        {std::hypot(base, low), std::hypot(base, high)});
  check(pair.wheel(), gears.second, true, face.wheel.below,
        {std::hypot(wheel_base, pair.wheel_roll_length(low)), std::hypot(wheel_base, pair.wheel_roll_length(high))});
}

void warn_of_backlash(std::vector<Warning>& list, double half_backlash, const geometry::GearPair& pair,
                      const std::string& mesh) {
  const double half = pair.normal_backlash() / 2;
  if (half_backlash <= half + 1 * units::um) return;
  list.push_back(
      {"backlash_beyond_geometry", Severity::warning,
       fmt::format("the dynamics uses the prescribed half backlash of {} µm; profile shifts and centre distance give "
                   "{} µm. Loss of contact and contact of back flanks depend on it",
                   to_text(half_backlash / units::um, 4), to_text(std::round(1e3 * half / units::um) / 1e3, 3)),
       mesh});
}

}  // namespace annulus::app
