#include "tests/benchmarks/promise/scenes.h"

#include <fmt/format.h>

#include "tests/app/scenes.h"

namespace annulus::benchmark {

namespace {

using test::replaced;

/// 118 N per millimetre of face width. All planets mesh in phase; one sits 10 µm off.
const std::string base = test::small_stage();

std::string with_rim(double thickness) {
  return replaced(base, "rim_thickness_mm = 24", fmt::format("rim_thickness_mm = {}", thickness));
}
std::string with_power(const std::string& text, double kW) {
  return replaced(text, "power_kW = 200", fmt::format("power_kW = {}", kW));
}
std::string with_supports(double rim, const char* structure, const char* more) {
  return replaced(with_rim(rim), "structure = \"traditional\"", fmt::format("structure = \"{}\"\n{}", structure, more));
}
/// Lines added to [sun] and [planet].
std::string with_teeth(const std::string& text, const std::string& lines) {
  return replaced(replaced(text, "[planet]", lines + "[planet]"), "[carrier]", lines + "[carrier]");
}

}  // namespace

std::vector<PromiseScene> promise_scenes() {
  return {
      {"thick", "held outside, rim 6 modules", base},
      {"thin", "held outside, rim 1 module", with_rim(4)},
      {"light", "held outside, a twentieth of the load, errors of 2 µm",
       replaced(with_power(base, 10), "planet_pin_position_error_um = [10,", "planet_pin_position_error_um = [2,")},
      {"parting", "fixed outside, a twentieth of the load: contact is lost", with_power(base, 10)},
      {"heavy", "held outside, three times the load", with_power(base, 600)},
      {"relief", "held outside, 15 µm tip relief on sun and planets",
       with_teeth(base, "tip_relief_um = 15\ntip_relief_length_mm = 4\n")},
      {"out_of_phase", "held outside, planets out of phase: sun 25, ring 71 teeth, 23 on each planet",
       replaced(replaced(replaced(replaced(base, "teeth = 24", "teeth = 25"), "teeth = 24", "teeth = 23"), "teeth = 72",
                         "teeth = 71"),
                "tip_diameter_mm = 282", "tip_diameter_mm = 278.5")},
      {"pins_24", "24 pins, rim 4 modules", with_supports(16, "pinned", "pins = 24\npin_diameter_mm = 10")},
      {"pins_6", "6 pins, rim 3 modules, light load",
       replaced(with_power(with_supports(12, "pinned", "pins = 6\npin_diameter_mm = 12"), 40),
                "planet_pin_position_error_um = [10,", "planet_pin_position_error_um = [2,")},
      {"pins_36", "36 pins, rim 2 modules, heavy load",
       with_power(with_supports(8, "pinned", "pins = 36\npin_diameter_mm = 8"), 600)},
      {"bolts_8", "8 bolts, rim 5 modules", with_supports(20, "bolted", "pins = 8\npin_diameter_mm = 14")},
      {"cantilever", "held at one end, rim 4 modules, sleeve of 10 mm",
       with_supports(16, "thin_walled", "free_length_mm = 10\nsleeve_thickness_mm = 14")},
      {"hoop", "held at one end, rim 2 modules, sleeve of 25 mm, a hoop",
       with_supports(8, "thin_walled",
                     "free_length_mm = 25\nsleeve_thickness_mm = 6\nhoop_width_mm = 12\nhoop_thickness_mm = 10")},
      {"crowned", "held outside, lead crowned by 8 µm", with_teeth(base, "lead_crowning_um = 8\n")},
      {"helical", "held outside, helix angle 12°",
       replaced(replaced(base, "module_mm = 4", "module_mm = 3.9125904\nhelix_angle_deg = 12"), "tip_diameter_mm = 282",
                "tip_diameter_mm = 282.2")},
  };
}

}  // namespace annulus::benchmark
