#include "app/plan/accuracy_choice.h"

#include <algorithm>

#include "fem/choice/table_choice.h"

namespace annulus::app {

MotionChoice motion_choice(double accuracy) {
  MotionChoice choice;
  if (accuracy >= fem::rough_accuracy) {
    choice.samples_per_cycle = 32;
    choice.samples_reason = "at least 32 samples per mesh cycle; more if they change the forces";
    choice.confirmation = dynamics::Confirmation::where_needed;
    choice.confirm_reason =
        "time integration confirms the motion if contact is lost or more samples still change the forces";
  } else {
    choice.samples_per_cycle = 64;
    choice.samples_reason = "64 samples per mesh cycle are within 0.1 % of any larger number";
    choice.confirm_reason = "time integration over a period must confirm the harmonic balance";
  }
  choice.relative_tolerance = std::clamp(1e-3 * accuracy, 1e-8, 1e-4);
  choice.tolerance_reason =
      "a thousandth of the accuracy: the errors of all steps add up over a period, and stay far below it";
  choice.steady_tolerance = std::clamp(0.1 * accuracy, 1e-3, 1e-2);
  return choice;
}

}  // namespace annulus::app
