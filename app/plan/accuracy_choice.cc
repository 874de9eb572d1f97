#include "app/plan/accuracy_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace annulus::app {

double load_uptake(double force, double face_width, double module, double youngs_modulus) {
  constexpr double steel = 206e9;                                      // Pa
  const double stiffness_per_width = 14e9 * (youngs_modulus / steel);  // N/m^2
  return std::sqrt(force / face_width / stiffness_per_width / module);
}

namespace {

/// The smallest one that linear plane elements reach at their first level.
constexpr double linear_accuracy = 0.01;

}  // namespace

TableResolution table_resolution(double accuracy, double uptake, double overlap_ratio) {
  TableResolution choice;
  if (overlap_ratio >= 1 && accuracy >= linear_accuracy) {
    choice.phases = table_phases;
    choice.phases_reason = "helical teeth that overlap by a pitch pass their load on slowly: 64 positions tell no more";
  } else if (accuracy >= very_rough_accuracy) {
    choice.phases = table_phases;
    choice.phases_reason = "between 32 positions dynamic factors are missed by 2 %, by 6 % under light loads";
  } else {
    choice.phases = 2 * table_phases;
    choice.phases_reason =
        "between 64 positions dynamic factors are missed by 0.1 %; between 32 by 2 %, 6 % under light loads";
    constexpr int most = 8 * table_phases;
    if (choice.phases * uptake < 1) {
      const double within = accuracy < linear_accuracy ? 2 : 1;  // positions within which it is taken up
      while (choice.phases < most && choice.phases * uptake < within) choice.phases *= 2;
      choice.phases_reason =
          fmt::format("the load is so light that a pair takes it up within {:.1g} of a mesh cycle", uptake);
    }
  }
  if (accuracy >= rough_accuracy) {
    choice.load_factors = {0.5, 1, 1.5};
    choice.loads_reason = "three loads tell how the stiffness follows the load; a single one would miss 1 to 2 %";
  } else {
    choice.load_factors = {std::begin(table_load_factors), std::end(table_load_factors)};
    choice.loads_reason = "five, down to a quarter and up to twice the nominal load: what dynamic loads reach";
  }
  return choice;
}

ElementChoice element_choice(fem::Fidelity fidelity, double accuracy, bool hard_for_linear,
                             const std::string& unfit_for_linear) {
  if (!unfit_for_linear.empty()) return {2, "quadratic elements: " + unfit_for_linear};
  const double enough = hard_for_linear ? rough_accuracy : linear_accuracy;
  if (accuracy >= enough && (fidelity == fem::Fidelity::plane || fidelity == fem::Fidelity::solid))
    return {1, fmt::format("linear elements are within {:.0f} % at once, at {} of the cost of quadratic ones, which "
                           "follow where they are not",
                           100 * enough, fidelity == fem::Fidelity::plane ? "half" : "an eighth")};
  if (fidelity == fem::Fidelity::solid)
    return {2, "quadratic elements are within 0.3 to 1 % at once, and their stresses can be used"};
  return {2, "quadratic elements are within 0.3 % at once, and their stresses can be used"};
}

MotionChoice motion_choice(double accuracy) {
  MotionChoice choice;
  if (accuracy >= rough_accuracy) {
    choice.samples_per_cycle = 32;
    choice.samples_reason = "32 samples per mesh cycle, their peaks refined, are within 1 % of any number";
    choice.confirm = false;
    choice.confirm_reason = "the harmonic balance is not confirmed unless contact is lost";
  } else {
    choice.samples_per_cycle = 64;
    choice.samples_reason = "64 samples per mesh cycle are within 0.1 % of any number";
    choice.confirm_reason = "time integration over a period must confirm the harmonic balance";
  }
  choice.relative_tolerance = std::clamp(1e-3 * accuracy, 1e-8, 1e-4);
  choice.tolerance_reason =
      "a thousandth of the accuracy: the errors of all steps add up over a period, and lie far below it";
  choice.steady_tolerance = std::clamp(0.1 * accuracy, 1e-3, 1e-2);
  return choice;
}

}  // namespace annulus::app
