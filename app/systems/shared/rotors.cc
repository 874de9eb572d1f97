#include "app/systems/shared/rotors.h"

#include <string>

#include "app/scene/key_checks.h"
#include "app/scene/scene_declare.h"

namespace annulus::app {

namespace {

/// Without the values that the lumped model alone needs.
std::vector<dynamics::Rotor> named_rotors(const Scene& scene) {
  std::vector<dynamics::Rotor> rotors;
  for (const auto& input : scene.rotors) rotors.push_back({.name = input.name, .on = input.on});
  return rotors;
}

class RotorChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run(const std::vector<dynamics::ShaftEnd>& ends) {
    const auto rotors = named_rotors(scene_);
    for (std::size_t i = 0; i < rotors.size(); ++i) {
      const auto fault = dynamics::rotor_fault(rotors, i, ends);
      if (!fault.name.empty() && usable("rotor.name", i)) problem("rotor.name", i, fault.name);
      if (!fault.on.empty() && usable("rotor.on", i)) problem("rotor.on", i, fault.on);
    }
  }
};

}  // namespace

Table rotor_table() {
  Declarations rotor("rotor",
                     "An inertia beside the gear set at the end of a shaft: motor, generator, load, flywheel. The "
                     "torque of a body acts on the last one of its rotors.",
                     &Scene::rotors);
  rotor.on_request().only_if(given("[dynamics]"), "the lumped model moves it");
  rotor.key("name", &RotorInput::name, "Name in results.").required();
  rotor
      .key("on", &RotorInput::on,
           "Where its shaft leads to: a body of the gear set that turns about the axis (sun, carrier, ring; pinion, "
           "wheel; input, output), or another rotor by its name.")
      .required();
  rotor.key("inertia_kg_m2", &RotorInput::inertia, "Moment of inertia about the axis, with half of its shaft.")
      .required()
      .from(least_inertia_kg_m2, 1e9);
  rotor.key("shaft_Nm_per_rad", &RotorInput::shaft, "Torsional stiffness of its shaft with the couplings.")
      .required()
      .above(0, 1e14);
  rotor
      .key("shaft_damping_ratio", &RotorInput::shaft_damping_ratio,
           "Damping ratio ζ of its shaft: c = 2ζ√(k J), 1/J = 1/J₁ + 1/J₂ of the inertias at its ends.")
      .from(0, 2)
      .absent("dynamics.support_damping_ratio");
  rotor
      .key("shaft_backlash_deg", &RotorInput::shaft_backlash,
           "Free rotation of its shaft in the couplings, from one side to the other.")
      .fallback(0.0, "couplings without backlash")
      .from(0, 360);
  return rotor.done();
}

void check_rotors(Scene& scene, std::vector<Problem>& problems, const std::vector<dynamics::ShaftEnd>& ends) {
  RotorChecker(scene, problems).run(ends);
}

std::vector<dynamics::Rotor> rotors_of(const Scene& scene) {
  auto rotors = named_rotors(scene);
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    const auto& input = scene.rotors[i];
    rotors[i].inertia = input.inertia;
    rotors[i].shaft_stiffness = input.shaft;
    rotors[i].shaft_damping_ratio = input.shaft_damping_ratio.value_or(scene.dynamics->support_damping_ratio);
    rotors[i].half_backlash = input.shaft_backlash / 2;
  }
  return rotors;
}

}  // namespace annulus::app
