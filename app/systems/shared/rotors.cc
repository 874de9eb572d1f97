#include "app/systems/shared/rotors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <utility>

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

  void places(const std::vector<dynamics::ShaftEnd>& ends) {
    const auto rotors = named_rotors(scene_);
    for (std::size_t i = 0; i < rotors.size(); ++i) {
      simple_name("rotor.name", i, rotors[i].name);
      const auto fault = dynamics::rotor_fault(rotors, i, ends);
      if (!fault.name.empty() && usable("rotor.name", i)) problem("rotor.name", i, fault.name);
      if (!fault.on.empty() && usable("rotor.on", i)) problem("rotor.on", i, fault.on);
    }
  }

  void ripple_lists() {
    for (std::size_t i = 0; i < scene_.rotors.size(); ++i) {
      const auto& input = scene_.rotors[i];
      const auto orders = input.ripple_orders.size();
      for (const auto& [key, values] : {std::pair{"rotor.ripple_torques_Nm", &input.ripple_torques},
                                        {"rotor.ripple_phases_deg", &input.ripple_phases}})
        if (usable(key, i) && given(key, i) && values->size() != orders)
          problem(key, i, fmt::format("has {} values for {} orders (ripple_orders)", values->size(), orders));
    }
  }
};

/// Waves through equidistant values over a turn, without their mean.
std::vector<dynamics::Rotor::Ripple> waves_of(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const double largest =
      values.empty() ? 0 : std::abs(*std::max_element(values.begin(), values.end(), [](double a, double b) {
        return std::abs(a) < std::abs(b);
      }));
  std::vector<dynamics::Rotor::Ripple> waves;
  for (std::size_t order = 1; 2 * order <= values.size(); ++order) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      sum += values[i] * std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(order * i) / count);
    sum *= (2 * order == values.size() ? 1 : 2) / count;
    constexpr double unseen = 1e-6;
    if (std::abs(sum) > unseen * largest) waves.push_back({static_cast<double>(order), std::abs(sum), std::arg(sum)});
  }
  return waves;
}

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
  rotor
      .key("ripple_orders", &RotorInput::ripple_orders,
           "Torques on it that change with its rotation, beside that of its body: their orders, in cycles per turn.")
      .together_with("ripple_torques_Nm")
      .longest(50)
      .distinct()
      .above(0, 1e4)
      .absent("a constant torque");
  rotor
      .key("ripple_torques_Nm", &RotorInput::ripple_torques,
           "Their amplitudes: torque × cos(order × angle + phase), in the sense of the torque of its body.")
      .longest(50)
      .from(0, 1e9)
      .absent("a constant torque");
  rotor.key("ripple_phases_deg", &RotorInput::ripple_phases, "Their phases at time 0.")
      .only_if(given("ripple_orders"))
      .longest(50)
      .from(-360, 360)
      .absent("0 for each");
  rotor
      .key("torque_over_turn_Nm", &RotorInput::torque_over_turn,
           "Torques on it over one of its turns, at equal angles from that at time 0 on, in the sense of the torque of "
           "its body: of cylinders, say. Their waves are taken, up to half as many per turn as there are values. Their "
           "mean is left out: the torque of the body is the mean.")
      .refused_if(given("ripple_orders"), "the values over a turn state all orders")
      .longest(100)
      .from(-1e9, 1e9)
      .absent("a constant torque");
  return rotor.done();
}

void check_rotors(Scene& scene, std::vector<Problem>& problems, const std::vector<dynamics::ShaftEnd>& ends) {
  RotorChecker(scene, problems).places(ends);
  check_ripple_lists(scene, problems);
}

void check_ripple_lists(Scene& scene, std::vector<Problem>& problems) { RotorChecker(scene, problems).ripple_lists(); }

std::vector<dynamics::Rotor> rotors_of(const Scene& scene) {
  auto rotors = named_rotors(scene);
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    const auto& input = scene.rotors[i];
    rotors[i].inertia = input.inertia;
    rotors[i].shaft_stiffness = input.shaft;
    rotors[i].shaft_damping_ratio = input.shaft_damping_ratio.value_or(scene.dynamics->support_damping_ratio);
    rotors[i].half_backlash = input.shaft_backlash / 2;
    for (std::size_t k = 0; k < input.ripple_orders.size(); ++k)
      rotors[i].ripples.push_back({input.ripple_orders[k], input.ripple_torques.at(k),
                                   input.ripple_phases.empty() ? 0 : input.ripple_phases.at(k)});
    for (const auto& wave : waves_of(input.torque_over_turn)) rotors[i].ripples.push_back(wave);
  }
  return rotors;
}

}  // namespace annulus::app
