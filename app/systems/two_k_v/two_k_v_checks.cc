#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/plan/mesh_model.h"
#include "app/scene/key_checks.h"
#include "app/scene/model_limits.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/shared/sun_planet_input.h"
#include "app/systems/two_k_v/two_k_v_input.h"
#include "app/systems/two_k_v/two_k_v_model.h"
#include "app/systems/two_k_v/two_k_v_scene.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// Whether the sun mesh is computed, instead of a prescribed stiffness or besides it.
bool computes_sun_mesh(const Scene& scene) {
  return sun_and_planets(scene).sun_planet.stiffness == StiffnessShape::computed ||
         two_k_v(scene).compare_sun_planet == Compare::computed;
}

class TwoKVChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    gears();
    wave(sun_and_planets(scene_).sun_planet, "mesh.sun_planet");
    wave(two_k_v(scene_).arc_pins, "mesh.arc_pins");
    arc_teeth();
    plane_models();
    dynamics();
    rotors();
  }

 private:
  void rotors() {
    dynamics::TwoKVStage stage;
    stage.input_support = two_k_v(scene_).input.support;
    stage.output_support = two_k_v(scene_).output.support;
    check_rotors(scene_, problems_, stage.shaft_ends());
  }

  void gears() {
    if (usable("stage.planets") && scene_.stage.planets < 2)
      problem(
          "stage.planets",
          "must be at least 2: a single crank has dead points, at which nothing holds the arc gears against turning");
    if (usable("stage.helix_angle_deg") && scene_.stage.helix_angle != 0)
      problem("stage.helix_angle_deg", "must be 0 or be left out: the model of a 2K-V stage has spur gears");
    if (!usable("sun.profile_shift") || !usable("planet.profile_shift")) return;
    const double sum = sun_and_planets(scene_).sun.profile_shift + sun_and_planets(scene_).planet.profile_shift;
    constexpr double rounding = 1e-9;  // of decimal fractions
    if (std::abs(sum) > rounding)
      problem("planet.profile_shift",
              fmt::format("must be {}, the opposite of the sun's: planets run at the reference centre distance of "
                          "module × (sun teeth + planet teeth) / 2",
                          to_text(-sun_and_planets(scene_).sun.profile_shift)));
  }

  void arc_teeth() {
    const auto& a = two_k_v(scene_).arc_gear;
    if (a.pin_circle_diameter && usable("arc_gear.eccentricity_mm") && usable("arc_gear.pins")) {
      const double least = 2 * a.eccentricity * a.pins;
      if (*a.pin_circle_diameter <= least)
        problem("arc_gear.pin_circle_diameter_mm",
                fmt::format("must be larger than 2 × eccentricity × pins = {} mm, else the pitch point lies beyond the "
                            "pins",
                            to_text(least / units::mm, 7)));
    }
    if (a.pin_circle_diameter && a.pin_diameter && usable("arc_gear.pins")) {
      const double distance = *a.pin_circle_diameter * std::sin(std::numbers::pi / a.pins);
      if (distance <= *a.pin_diameter)
        problem("arc_gear.pin_diameter_mm",
                fmt::format("pins overlap: their centres are {} mm apart; make them thinner or fewer",
                            to_text(distance / units::mm, 5)));
    }
    if (a.arc_radius && a.pin_diameter && *a.arc_radius <= *a.pin_diameter / 2)
      problem("arc_gear.arc_radius_mm",
              fmt::format("must be larger than the pin's radius of {} mm, on which the arc rolls",
                          to_text(*a.pin_diameter / 2 / units::mm)));
  }

  void plane_models() {
    const bool plane = scene_.fidelity == Fidelity::plane || scene_.fidelity == Fidelity::closed_form;
    if (!plane || !computes_sun_mesh(scene_)) return;
    const std::string why = fem::solid_reason(
        {}, face_features(scene_, sun_and_planets(scene_).planet, "planet", sun_and_planets(scene_).sun, "sun", 0));
    if (!why.empty())
      problem("model", fmt::format("cannot represent the sun-planet mesh: {}; use \"automatic\" or \"solid\"", why));
  }

  void dynamics() {
    if (!scene_.dynamics) return;
    if (std::isinf(two_k_v(scene_).input.support) && std::isinf(two_k_v(scene_).output.support))
      problem("output.support_Nm_per_rad",
              "no torque acts where input and output are both fixed; leave input.support_Nm_per_rad out");
  }
};

}  // namespace

void check_two_k_v_scene(Scene& scene, std::vector<Problem>& problems) { TwoKVChecker(scene, problems).run(); }

void check_two_k_v_geometry(const Scene& scene, const geometry::GearPair& pair) {
  if (computes_sun_mesh(scene)) {
    check_bore(scene, "sun", sun_and_planets(scene).sun, pair.wheel());
    check_bore(scene, "planet", sun_and_planets(scene).planet, pair.pinion());
  }
  constexpr const char* load = "output.torque_Nm";
  const auto stage = two_k_v_kinematics(scene);
  const double sun_force = stage.mean_sun_mesh_force(), arc_force = std::abs(stage.mean_arc_mesh_force());
  if (scene.dynamics) {
    const double crank = std::abs(two_k_v(scene).output.torque) / (stage.cranks * stage.crank_circle_radius());
    check_prescribed_mesh(scene, load, sun_and_planets(scene).sun_planet, std::abs(sun_force));
    check_prescribed_mesh(scene, load, two_k_v(scene).arc_pins, arc_force);
    check_bearing(scene, "crank.bearing_N_per_m", *two_k_v(scene).crank.bearing, crank);
    check_bearing(scene, "arc_gear.bearing_N_per_m", *two_k_v(scene).arc_gear.bearing, arc_force);
  }
  if (computes_sun_mesh(scene))
    check_load(scene, load, sun_force, pair.common_face().width,
               fem::MeshMaterials(material_of(scene, sun_and_planets(scene).planet),
                                  material_of(scene, sun_and_planets(scene).sun))
                   .youngs_modulus());
}

}  // namespace annulus::app
