#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <optional>
#include <set>

#include "app/plan/gear_geometry.h"
#include "app/results/result_folder.h"
#include "app/scene/key_checks.h"
#include "app/scene/scene_limits.h"
#include "app/scene/scene_schema.h"
#include "app/systems/planetary/pitch_deviations.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/planetary_scene.h"
#include "app/systems/planetary/power_flow.h"
#include "app/systems/planetary/ring_structures.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/planetary/strain_gauges.h"
#include "app/systems/planetary/structure_tables.h"
#include "app/systems/shared/profile_shifts.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

class PlanetaryChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    rings_by_their_inputs();
    planet_angles();
    errors();
    bearings();
    planet_on_rollers();
    profile_shifts();
    ring_names();
    held_supports();
    // Problems of rings with the same name could not be assigned, so only the first one is checked.
    std::set<std::string> seen;
    for (auto& ring : planetary(scene_).rings) {
      if (seen.insert(ring.name).second) check_structure(ring, scene_, problems_);
    }
    wave(sun_and_planets(scene_).sun_planet, "mesh.sun_planet");
    wave(planetary(scene_).ring_planet, "mesh.ring_planet");
    single_supports();
    plane_models();
    rim_coupling();
    tolerances();
    check_strain_gauges(scene_, problems_);
    check_pitch_deviations(scene_, problems_);
    check_structure(scene_, problems_);
    check_power_flow(scene_, problems_);
    rotors();
  }

 private:
  /// Problems find the inputs of a ring by its name, also where that is none that may be used.
  void rings_by_their_inputs() {
    for (const auto& input : scene_.inputs)
      if (!input.variant.empty()) planetary(scene_).rings.at(input.entry).name = input.variant;
  }

  void rotors() {
    dynamics::PlanetaryStage stage;
    for (const auto member : geometry::stage_members)
      stage.body(member).torsional_support = torsional_support(scene_, member);
    check_rotors(scene_, problems_, stage.shaft_ends());
  }

  void planet_angles() {
    const std::string key = "stage.planet_angles_deg";
    if (!given(key) || !usable(key) || !usable("stage.planets")) return;
    const auto& angles = planetary(scene_).stage.planet_angles;
    if (angles.size() != static_cast<std::size_t>(scene_.stage.planets)) {
      problem(key,
              fmt::format("needs one angle per planet: {} angles for {} planets", angles.size(), scene_.stage.planets));
    } else if (angles.front() != 0) {
      problem(key, "the first angle must be 0, from which the others are measured");
    } else if (std::adjacent_find(angles.begin(), angles.end(), std::greater_equal<>()) != angles.end() ||
               angles.back() >= 2 * std::numbers::pi) {
      problem(key, "angles must increase and stay below 360");
    }
  }

  void profile_shifts() {
    using geometry::GearKind;
    std::vector<ShiftedGear> gears = {
        {"sun", &sun_and_planets(scene_).sun, GearKind::external, &sun_and_planets(scene_).planet, "planet"},
        {"planet", &sun_and_planets(scene_).planet, GearKind::external, &sun_and_planets(scene_).sun, "sun"}};
    for (auto& ring : planetary(scene_).rings)
      gears.push_back({"ring", &ring, GearKind::internal, &sun_and_planets(scene_).planet, "planet", ring.name});
    resolve_profile_shifts(scene_, problems_, gears);
  }

  void errors() {
    auto& e = planetary(scene_).errors;
    list("errors.planet_eccentricity_um", e.planet_eccentricity);
    list("errors.planet_eccentricity_phase_deg", e.planet_eccentricity_phase);
    list("errors.planet_pin_position_error_um", e.planet_pin_position);
    list("errors.planet_pin_position_error_phase_deg", e.planet_pin_position_phase);
  }

  void bearings() {
    for (const auto& [key, values] :
         {std::pair{"supports.planet_radial_N_per_m", &planetary(scene_).supports.planet_radial},
          {"supports.planet_tangential_N_per_m", &planetary(scene_).supports.planet_tangential}})
      if (given(key)) list(key, *values);
    const auto& s = planetary(scene_).supports;
    const std::string clearance = "supports.planet_clearance_um";
    if (s.planet_clearance == 0 || !usable(clearance) || !usable("supports.planet_N_per_m")) return;
    if (s.planet == rigid) problem(clearance, "needs a bearing that gives way: supports.planet_N_per_m is rigid");
  }

  void planet_on_rollers() {
    const std::string key = "planet.bore";
    if (sun_and_planets(scene_).planet.bore != BoreOn::rollers || !usable(key)) return;
    if (usable("supports.planet_N_per_m") && planetary(scene_).supports.planet == rigid)
      problem(key, "needs a bearing that gives way: supports.planet_N_per_m is rigid");
    if (usable("stage.helix_angle_deg") && scene_.stage.helix_angle != 0)
      problem(key, "is not modelled for helical teeth; use \"hub\"");
    if (usable("model") && (scene_.fidelity == Fidelity::closed_form || scene_.fidelity == Fidelity::resolved))
      problem(key,
              "needs a whole planet of finite elements; use model = \"automatic\", \"plane\" or \"solid\", or \"hub\"");
  }

  void list(const std::string& key, std::vector<double>& values) {
    if (!usable("stage.planets") || (given(key) && !usable(key))) return;
    const auto planets = static_cast<std::size_t>(scene_.stage.planets);
    if (values.empty() && !given(key)) values.assign(planets, 0);
    if (values.size() != planets) {
      problem(key, fmt::format("needs one value per planet: {} values for {} planets", values.size(), planets));
    }
  }

  /// Rings on pins, bolts or splines, and helical gears in the resolved model.
  void single_supports() {
    const bool resolved = scene_.fidelity == Fidelity::resolved, helical = scene_.stage.helix_angle != 0;
    if (resolved && helical) problem("model", "cannot represent helical gears: use \"automatic\" or \"solid\"");
    if (planetary(scene_).ring_planet.stiffness != StiffnessShape::computed) return;
    for (const auto& ring : planetary(scene_).rings) {
      if (!fem::on_single_supports(ring_structure(ring))) continue;
      if (resolved)
        problem("model",
                fmt::format("cannot represent the ring-planet mesh of '{}': the resolved model does not cover rings "
                            "on pins, bolts or splines; use \"automatic\"",
                            ring.name));
    }
  }

  /// Models in which nothing changes along the face width are refused where something does.
  void plane_models() {
    if (scene_.fidelity != Fidelity::plane && scene_.fidelity != Fidelity::closed_form) return;
    const auto refuse = [&](const std::string& mesh, const std::string& why) {
      if (why.empty()) return;
      problem("model",
              fmt::format("cannot represent the {}: {}; use \"automatic\", \"solid\" or \"resolved\"", mesh, why));
    };
    if (sun_and_planets(scene_).sun_planet.stiffness == StiffnessShape::computed)
      refuse("sun-planet mesh", solid_reason(scene_));
    if (planetary(scene_).ring_planet.stiffness != StiffnessShape::computed) return;
    for (const auto& ring : planetary(scene_).rings)
      refuse(fmt::format("ring-planet mesh of '{}'", ring.name), solid_reason(scene_, ring));
  }

  /// A member that is held needs a torsional support, one that turns may not be held rigidly.
  void held_supports() {
    for (const auto member : stage_members) {
      const auto key = fmt::format("supports.{}_torsional_N_per_m", to_string(member));
      const bool held = planetary(scene_).stage.held == member;
      if (!given(key) || !usable(key) || !usable("stage.held")) continue;
      const double stiffness = torsional_support(scene_, member);
      if (held && stiffness == 0)
        problem(key, fmt::format("leaves the {} free, but stage.held says that it is held; use a stiffness above 0 or "
                                 "\"rigid\"",
                                 to_string(member)));
      if (!held && stiffness == rigid)
        problem(key, fmt::format("holds the {} rigidly, but stage.held = \"{}\" lets it turn; use a finite stiffness "
                                 "or leave it out",
                                 to_string(member),
                                 planetary(scene_).stage.held ? to_string(*planetary(scene_).stage.held) : "none"));
    }
  }

  void ring_names() {
    constexpr const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+.";
    std::set<std::string> seen;
    for (const auto& ring : planetary(scene_).rings) {
      if (seen.contains(ring.name)) continue;
      seen.insert(ring.name);
      const bool allowed_name = !ring.name.empty() && ring.name.front() != '.' &&
                                ring.name.find_first_not_of(allowed) == std::string::npos && ring.name.size() <= 64;
      if (!allowed_name) {
        problem("ring.name", ring.name,
                "names a folder: letters, digits, '-', '_', '+' and '.' only, not starting with '.', at most 64");
      } else if (is_name_of_run(ring.name)) {
        problem("ring.name", ring.name, "is the name of a file or folder that a run writes itself; choose another one");
      }
    }
    seen.clear();
    for (const auto& input : scene_.inputs) {
      if (input.key != "ring.name" || seen.insert(input.variant).second) continue;
      problems_.push_back(
          {input.line, input.column,
           fmt::format("ring.name = {}: is the name of more than one ring; each needs its own", shown(input.variant))});
    }
  }

  void tolerances() {
    if (!planetary(scene_).tolerances) return;
    const auto& t = *planetary(scene_).tolerances;
    const bool any = t.accuracy_class || t.sun_class || t.planet_class || t.ring_class ||
                     t.sun_runout.value_or(0) > 0 || t.planet_runout.value_or(0) > 0 || t.ring_runout.value_or(0) > 0 ||
                     t.planet_pin_position.value_or(0) > 0;
    const std::string first = "tolerances.assemblies";
    if (!any)
      problem(first,
              "has no tolerance to draw within: give tolerances.accuracy_class, a runout or "
              "tolerances.planet_pin_position_um above zero");
    if (usable("stage.planets") && scene_.stage.planets < 2)
      problem(first, "a single planet shares the load with none: leave [tolerances] out");
  }

  void rim_coupling() {
    if (!scene_.dynamics) return;
    const auto coupling = planetary(scene_).rim_coupling;
    if (coupling != RimCoupling::elastic && coupling != RimCoupling::statical) return;
    if (planetary(scene_).ring_planet.stiffness != StiffnessShape::computed)
      problem("dynamics.rim_coupling",
              "needs a computed ring mesh: a prescribed stiffness does not describe the ring; use \"none\" or "
              "\"automatic\"");
    if (coupling == RimCoupling::elastic && usable("stage.held") &&
        planetary(scene_).stage.held != geometry::StageMember::ring)
      problem("dynamics.rim_coupling",
              "is not modelled for a ring that turns (stage.held), whose modes would need its Coriolis forces; use "
              "\"static\" or \"automatic\"");
    for (const auto& ring : planetary(scene_).rings)
      if (ring_structure(ring).single_supports() == 1)
        problem("dynamics.rim_coupling",
                fmt::format("is not modelled for the ring '{}' on a single pin, which rests in its housing: use "
                            "\"none\" or \"automatic\", or give the ring more pins",
                            ring.name));
  }
};

}  // namespace

void check_planetary_scene(Scene& scene, std::vector<Problem>& problems) { PlanetaryChecker(scene, problems).run(); }

}  // namespace annulus::app
