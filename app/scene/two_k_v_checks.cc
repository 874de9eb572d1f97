#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/plan/mesh_model.h"
#include "app/scene/key_checks.h"
#include "app/scene/scene_checks.h"
#include "core/units.h"

namespace annulus::app {

namespace {

class TwoKVChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    gears();
    mesh(scene_.sun_planet, "mesh.sun_planet");
    mesh(scene_.arc_pins, "mesh.arc_pins");
    compared(scene_.sun_planet, "mesh.sun_planet");
    compared(scene_.arc_pins, "mesh.arc_pins");
    const bool sun = wanted(scene_.sun_planet), arc = wanted(scene_.arc_pins);
    const char* why = scene_.sun_planet.stiffness == StiffnessShape::computed
                          ? "the computed sun-planet mesh; or give its stiffness in [mesh.sun_planet]"
                          : "mesh.sun_planet.compare = \"computed\"";
    needed(sun, {"sun.bore_diameter_mm", "planet.bore_diameter_mm"}, why);
    why = scene_.arc_pins.stiffness == StiffnessShape::computed
              ? "the computed mesh of arc teeth and pins; or give its stiffness in [mesh.arc_pins]"
              : "mesh.arc_pins.compare = \"computed\"";
    needed(
        arc,
        {"arc_gear.pin_circle_diameter_mm", "arc_gear.pin_diameter_mm", "arc_gear.arc_radius_mm", "arc_gear.width_mm"},
        why);
    arc_teeth();
    fidelity(sun);
    dynamics();
  }

 private:
  static bool wanted(const MeshInput& m) {
    return m.stiffness == StiffnessShape::computed || m.compare == Compare::computed;
  }

  /// A table that is missing as a whole is told about once.
  void needed(bool condition, const std::vector<std::string>& keys, const char* why) {
    for (const auto& key : keys) required_if(condition && find(key), {key}, "", why);
  }

  void gears() {
    if (usable("stage.planets") && scene_.stage.planets < 2)
      problem(
          "stage.planets", "",
          "must be at least 2: a single crank has dead points, at which nothing holds the arc gears against turning");
    if (usable("stage.helix_angle_deg") && scene_.stage.helix_angle != 0)
      problem("stage.helix_angle_deg", "", "the model of a 2K-V stage has spur gears: leave it out or give 0");
    if (given("sun.mass_kg"))
      problem("sun.mass_kg", "", "has no meaning here: the sun of a 2K-V stage only turns; leave it out");
    if (!usable("sun.profile_shift") || !usable("planet.profile_shift")) return;
    const double sum = scene_.sun.profile_shift + scene_.planet.profile_shift;
    constexpr double rounding = 1e-9;  // of decimal fractions
    if (std::abs(sum) > rounding)
      problem("planet.profile_shift", "",
              fmt::format("must be {}, the opposite of the sun's: planets run at the reference centre distance of "
                          "module × (sun teeth + planet teeth) / 2",
                          to_text(-scene_.sun.profile_shift)));
  }

  void compared(const MeshInput& m, const std::string& path) {
    if (m.stiffness == StiffnessShape::computed && m.compare == Compare::computed && given(path + ".compare"))
      problem(path + ".compare", "", "has a meaning only with a given stiffness; this one is computed");
  }

  void arc_teeth() {
    const auto& a = scene_.arc_gear;
    if (a.pin_circle_diameter && usable("arc_gear.eccentricity_mm") && usable("arc_gear.pins")) {
      const double least = 2 * a.eccentricity * a.pins;
      if (*a.pin_circle_diameter <= least)
        problem("arc_gear.pin_circle_diameter_mm", "",
                fmt::format("must be larger than 2 × eccentricity × pins = {} mm, else the pitch point lies beyond the "
                            "pins",
                            to_text(least / units::mm, 7)));
    }
    if (a.pin_circle_diameter && a.pin_diameter && usable("arc_gear.pins")) {
      const double distance = *a.pin_circle_diameter * std::sin(std::numbers::pi / a.pins);
      if (distance <= *a.pin_diameter)
        problem("arc_gear.pin_diameter_mm", "",
                fmt::format("pins overlap: their centres are {} mm apart; make them thinner or fewer",
                            to_text(distance / units::mm, 5)));
    }
    if (a.arc_radius && a.pin_diameter && *a.arc_radius <= *a.pin_diameter / 2)
      problem("arc_gear.arc_radius_mm", "",
              fmt::format("must be larger than the pin's radius of {} mm, on which the arc rolls",
                          to_text(*a.pin_diameter / 2 / units::mm)));
    if (a.clearance != 0 && !wanted(scene_.arc_pins))
      problem("arc_gear.clearance_um", "",
              "has a meaning only with a computed mesh of arc teeth and pins; a given stiffness has half_backlash_um");
  }

  void fidelity(bool sun_computed) {
    if (!sun_computed || (scene_.fidelity != Fidelity::plane && scene_.fidelity != Fidelity::closed_form)) return;
    const std::string why = solid_reason(scene_);
    if (!why.empty())
      problem("model", "",
              fmt::format("cannot represent the sun-planet mesh: {}; use \"automatic\" or \"solid\"", why));
  }

  void dynamics() {
    if (!scene_.dynamics) return;
    if (!find("input.inertia_kg_m2") || !given("input.inertia_kg_m2"))
      problem("input.inertia_kg_m2", "",
              "is required by [dynamics]: with the ratio squared it sets the lowest frequency");
    needed(true,
           {"input.shaft_Nm_per_rad", "sun.inertia_kg_m2", "planet.mass_kg", "planet.inertia_kg_m2",
            "crank.inertia_kg_m2", "crank.shaft_Nm_per_rad", "crank.bearing_N_per_m", "arc_gear.mass_kg",
            "arc_gear.inertia_kg_m2", "arc_gear.bearing_N_per_m", "output.inertia_kg_m2"},
           "[dynamics]");
    if (std::isinf(scene_.input.support) && std::isinf(scene_.output.support))
      problem("output.support_Nm_per_rad", "",
              "no torque acts where input and output are both held; leave input.support_Nm_per_rad out");
    integrator();
  }
};

}  // namespace

void check_two_k_v_keys(Scene& scene, std::vector<Problem>& problems) { TwoKVChecker(scene, problems).run(); }

}  // namespace annulus::app
