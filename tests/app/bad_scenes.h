#pragma once

#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"

namespace annulus::test {

/// A good scene of each kind that asks for everything there is, so that each table has its place in it.
struct GoodScene {
  const char* name;
  std::string kind;
  std::string text;
};

inline std::string studies_of(const std::string& input, const std::string& other, const std::string& figure) {
  return "[[sweep]]\ninput = \"" + input + "\"\nvalues = [0.05, 0.06]\n[[grid]]\nx_input = \"" + input +
         "\"\nx_values = [0.05, 0.06]\ny_input = \"" + other +
         "\"\ny_values = [0.03, 0.04]\n[monte_carlo]\nsamples = 2\n[[monte_carlo.input]]\ninput = \"" + input +
         "\"\ndistribution = \"uniform\"\nlow = 0.05\nhigh = 0.06\n[sensitivity]\nfactor = 1.1\n[optimise]\nobjective "
         "= "
         "[\"" +
         figure + "\"]\n[[optimise.variable]]\ninput = \"" + input + "\"\nlow = 0.05\nhigh = 0.06\n";
}

/// Rings on single supports, on a flange, on a sleeve with a hoop and on splines, all computed.
inline std::string computed_set() {
  auto text = quick_scene();
  const auto cut = text.find("[mesh.sun_planet]"), end = text.find("[dynamics]");
  text.erase(cut, end - cut);
  text = replaced(text, "[planet]\nteeth = 55", "[planet]\nbore_diameter_mm = 90\nteeth = 55");
  text = replaced(text, "[sun]\nteeth = 48", "[sun]\nbore_diameter_mm = 60\nteeth = 48");
  const std::string ring =
      "teeth = 162\nprofile_shift = 0.1516\nrim_thickness_mm = 20\nmass_kg = 31.25\ninertia_kg_m2 = 2.9606\n";
  const auto add = [&](const std::string& name, const std::string& structure, const std::string& keys) {
    text =
        replaced(text, "[errors]",
                 "[[ring]]\nname = \"" + name + "\"\nstructure = \"" + structure + "\"\n" + ring + keys + "[errors]");
  };
  add("flange", "traditional", "flange_width_mm = 20\nflange_diameter_mm = 720\n");
  add("sleeve", "thin_walled",
      "free_length_mm = 18\nsleeve_thickness_mm = 10\nhoop_width_mm = 10\nhoop_thickness_mm = 5\n");
  add("pins", "pinned", "pins = 24\npin_diameter_mm = 15.5\npin_clearance_um = 3\nfirst_pin_angle_deg = 1\n");
  add("bolts", "bolted", "pin_angles_deg = [0, 90, 180, 270]\npin_diameter_mm = 15.5\n");
  add("spline", "splined", "splines = 54\nspline_clearance_um = 2\n");
  add("clamped", "clamped",
      "clamp_inner_diameter_mm = 640\nbolts = 36\nbolt_circle_diameter_mm = 652\nbolt_diameter_mm = 9\ndowels = 6\n"
      "dowel_diameter_mm = 8\n");
  return text;
}

inline std::vector<GoodScene> good_scenes() {
  constexpr const char* damping = "dynamics.mesh_damping_ratio";
  constexpr const char* support = "dynamics.support_damping_ratio";
  return {{"planetary, prescribed stiffness", "planetary",
           quick_scene() + studies_of(damping, support, "sun_planet_load_sharing_instantaneous")},
          {"planetary, computed", "planetary", computed_set()},
          {"helical pair", "helical_pair",
           quick_pair() + "[transmission_error]\npinion_torques_Nm = [20000]\n" +
               studies_of(damping, support, "dynamic_factor")},
          {"2K-V", "two_k_v", reducer_scene() + studies_of(damping, support, "frequency_1_Hz")}};
}

}  // namespace annulus::test
