#include "app/systems/planetary/power_flow.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "app/scene/key_checks.h"
#include "app/systems/planetary/pitch_deviations.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/ring_structures.h"
#include "app/systems/planetary/structure_tables.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/units.h"

namespace annulus::app {

namespace {

using geometry::StageMember;

/// A turn in two years; powers divided by less are no torques.
constexpr double slowest = 1e-6 * units::rpm;

std::string speed_key(StageMember member) { return fmt::format("stage.{}_speed_rpm", to_string(member)); }

const std::optional<double>& given_speed(const PlanetaryStageInput& stage, StageMember member) {
  return member == StageMember::sun       ? stage.sun_speed
         : member == StageMember::carrier ? stage.carrier_speed
                                          : stage.ring_speed;
}

/// Angles in the mirror image count the other way round. Planets keep their numbers.
void mirror(Scene& scene) {
  scene.stage.helix_angle = -scene.stage.helix_angle;
  const auto reversed = [](double angle) { return angle == 0 ? 0 : 2 * std::numbers::pi - angle; };
  const auto planets = static_cast<std::size_t>(scene.stage.planets);
  auto& angles = planetary(scene).stage.planet_angles;
  if (angles.empty() && planets > 0 &&
      (sun_and_planets(scene).sun.teeth + planetary(scene).rings.front().teeth) % scene.stage.planets == 0)
    for (std::size_t n = 0; n < planets; ++n)
      angles.push_back(2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(planets));
  for (double& angle : angles) angle = reversed(angle);
  for (auto& ring : planetary(scene).rings) mirror_structure(ring);
  const auto swap_flanks = [](GearInput& gear) { std::swap(gear.leading_flank, gear.trailing_flank); };
  swap_flanks(sun_and_planets(scene).sun);
  swap_flanks(sun_and_planets(scene).planet);
  for (auto& ring : planetary(scene).rings) swap_flanks(ring);
  for (auto& gauge : planetary(scene).strain_gauges) {
    gauge.angle = -gauge.angle;
    gauge.offset = -gauge.offset;
  }
  mirror_space(scene);
  auto& e = planetary(scene).errors;
  mirror_pitch_deviations(scene);
  for (auto* phases : {&e.planet_eccentricity_phase, &e.planet_pin_position_phase})
    for (double& phase : *phases) phase = -phase;
  for (auto* body : {&e.sun, &e.ring, &e.carrier}) {
    body->eccentricity_phase = -body->eccentricity_phase;
    body->position_phase = -body->position_phase;
  }
}

class PowerFlowChecks : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    if (!usable("stage.held") || !usable("stage.drives")) return;
    if (stage().held == stage().drives)
      return problem("stage.drives", fmt::format("the {} is held (stage.held) and cannot drive; use {}",
                                                 to_string(stage().drives), fmt::join(turning(), " or ")));
    if (number_of_speeds() && usable("sun.teeth") && usable("ring.teeth") && !planetary(scene_).rings.empty() &&
        sun_and_planets(scene_).sun.teeth > 0 && planetary(scene_).rings.front().teeth > 0 && values_of_speeds() &&
        clockwise_torque())
      mirror(scene_);
  }

 private:
  [[nodiscard]] const PlanetaryStageInput& stage() const { return planetary(scene_).stage; }

  /// In quotes, the members that turn.
  [[nodiscard]] std::vector<std::string> turning() const {
    std::vector<std::string> names;
    for (const auto member : stage_members)
      if (stage().held != member) names.push_back(fmt::format("\"{}\"", to_string(member)));
    return names;
  }

  bool number_of_speeds() {
    const std::size_t needed = stage().held ? 1 : 2;
    std::vector<std::string> possible, found;
    for (const auto member : stage_members) {
      const auto key = speed_key(member);
      if (given(key) && !usable(key)) return false;  // refused for another reason
      if (stage().held == member) {
        if (given(key)) return false;  // refused by its rule
        continue;
      }
      possible.push_back(key);
      if (given(key)) found.push_back(key);
    }
    if (found.size() == needed) return true;
    if (found.empty()) return false;  // refused by the rule of these keys
    if (found.size() < needed) {
      problem(found.front() == possible.front() ? possible[1] : possible.front(),
              fmt::format("two of {} are required: no member is held (stage.held)", fmt::join(possible, ", ")));
    } else {
      problem(found.back(),
              fmt::format("is given beside {}; give {} of {}", fmt::join(found.begin(), found.end() - 1, " and "),
                          needed == 1 ? "one" : "two", fmt::join(possible, ", ")));
    }
    return false;
  }

  bool values_of_speeds() {
    if (stage().held)
      for (const auto member : stage_members)
        if (const auto& speed = given_speed(stage(), member); speed && std::abs(*speed) < slowest) {
          problem(speed_key(member),
                  "must be at least 1e-06 r/min in one direction or the other, so that the stage turns");
          return false;
        }
    const auto speeds = this->speeds();
    const double rolling = speeds[StageMember::carrier] - speeds[StageMember::ring];
    if (std::abs(rolling) < slowest) {
      problem(first_speed(), "all members then turn at the same speed, and the teeth do not roll on each other");
      return false;
    }
    if (std::abs(speeds[stage().drives]) < slowest) {
      problem("stage.drives",
              fmt::format("the {} turns at {} r/min and can drive nothing; use {}", to_string(stage().drives),
                          to_text(speeds[stage().drives] / units::rpm, 3), fmt::join(turning(), " or ")));
      return false;
    }
    return true;
  }

  [[nodiscard]] geometry::MemberValues speeds() const {
    return stage_speeds(stage(), sun_and_planets(scene_).sun.teeth, planetary(scene_).rings.front().teeth);
  }
  [[nodiscard]] std::string first_speed() const {
    for (const auto member : stage_members)
      if (given_speed(stage(), member)) return speed_key(member);
    return speed_key(StageMember::sun);
  }

  /// Of the sun.
  [[nodiscard]] bool clockwise_torque() const {
    return geometry::member_torques(sun_and_planets(scene_).sun.teeth, planetary(scene_).rings.front().teeth,
                                    stage().drives, speeds()[stage().drives])[StageMember::sun] < 0;
  }
};

}  // namespace

Scene as_drawn(const Scene& scene, const OperatingPoint& point) {
  Scene drawn = scene;
  if (point.mirrored) mirror(drawn);
  return drawn;
}

void check_power_flow(Scene& scene, std::vector<Problem>& problems) { PowerFlowChecks(scene, problems).run(); }

std::string role_of(const Scene& scene, const OperatingPoint& point, StageMember member) {
  if (planetary(scene).stage.held == member) return "held";
  const double power = point.flow.power(member), least = 1e-9 * std::abs(point.power);
  return power > least ? "drives" : power < -least ? "delivers" : "carries torque at rest";
}

}  // namespace annulus::app
