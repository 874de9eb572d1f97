#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/random/draw.h"
#include "tests/random/scene_draft.h"

namespace annulus::random {

/// The sizes of a gear set, from which usual values of all other quantities follow.
struct Scales {
  double module_mm = 1;
  double deflection_um = 1;         ///< of a mesh under the nominal load
  double stiffness_N_per_m = 1;     ///< of a mesh
  double torsional_Nm_per_rad = 1;  ///< of a mesh, about the axis of its smaller gear
};

/// Gears that mesh, with their load. The rest of the scene is drawn from the declarations of the schema.
struct GearSet {
  SceneDraft draft;  ///< kind, gears, operating point
  Scales scales;
  std::map<std::string, app::Value> values;  ///< of keys that have to fit the gears, where they are drawn
  std::map<std::string, double> chances;     ///< of optional keys and tables, where not the usual one
  std::vector<std::pair<std::string, std::string>> together{};  ///< keys that make sense together only
  int planets = 1;                                              ///< values of the lists
};

/// What a set may have: the same along the face width, anything, or what the resolved model covers.
enum class Section { plane, solid, resolved };

[[nodiscard]] GearSet planetary_set(Draw& draw, Section section);
[[nodiscard]] GearSet helical_pair_set(Draw& draw, Section section);
[[nodiscard]] GearSet two_k_v_set(Draw& draw, Section section);

/// What the three share: material, basic rack, face width.
struct Rack {
  double module_mm = 1, pressure_angle_deg = 20, helix_angle_deg = 0, face_width_mm = 10, youngs_modulus_GPa = 206;

  [[nodiscard]] double transverse_module_mm() const;
  [[nodiscard]] double transverse_pressure_angle() const;  ///< rad
  /// Below it the rack undercuts the flank, with any root fillet that is drawn.
  [[nodiscard]] double least_profile_shift(long teeth) const;
  /// N/m: 14 N/(mm µm) of steel, in proportion to the modulus.
  [[nodiscard]] double mesh_stiffness() const { return 1.4e7 * face_width_mm * youngs_modulus_GPa / 206; }
  /// N: a line load in proportion to module and modulus.
  [[nodiscard]] double mesh_force(Draw& draw) const {
    return draw.log_uniform(0.3, 30) * module_mm * face_width_mm * youngs_modulus_GPa / 206;
  }
};
[[nodiscard]] Rack draw_rack(Draw& draw, Section section, SceneDraft& draft);

/// What holds for the keys of the flanks of a gear.
void flank_keys(GearSet& set, const std::string& gear, Section section);
/// No misalignment of a mesh that is the same along the face width.
/// A gear now and then has a material of its own.
void material_keys(Draw& draw, GearSet& set, const std::string& gear, const Rack& rack);
/// Face width and offset of a gear: near those of the others, so that a plane section still stands for all.
void face_keys(Draw& draw, GearSet& set, const std::string& gear, const Rack& rack);
void mesh_keys(GearSet& set, const std::string& mesh, Section section);

/// kg and kg m² of a disc of this diameter, 0.7 to 1.5 times that of a solid one of steel.
struct Disc {
  double mass = 0, inertia = 0;
};
[[nodiscard]] Disc draw_disc(Draw& draw, double diameter_mm, double width_mm);

}  // namespace annulus::random
