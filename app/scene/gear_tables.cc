#include "app/scene/gear_tables.h"

#include "app/scene/scene_files.h"
#include "core/errors.h"

namespace annulus::app {

std::shared_ptr<const geometry::FlankTopography> measured_flank(const Scene& scene, const std::string& file) {
  if (scene.fidelity == Fidelity::closed_form || scene.fidelity == Fidelity::resolved)
    throw InputError(
        "formulas and resolved models do not cover measured flanks; use model = \"automatic\", \"plane\" or "
        "\"solid\"");
  return std::make_shared<const geometry::FlankTopography>(
      geometry::read_flank_topography(file_below_scene(scene, file)));
}

Declared declare_centre_distance(Declarations<StageInput>& stage) {
  Declared key = stage.key("centre_distance_mm", &StageInput::centre_distance,
                           "Working centre distance of sun and planet, or of pinion and wheel.");
  key.above(0, 1e5);
  return key;
}

void declare_tip_shortening(Declarations<StageInput>& stage) {
  stage
      .choice("tip_shortening", &StageInput::tip_shortening,
              {{"none", TipShortening::none}, {"full", TipShortening::full}},
              "Tip circles of external gears without tip_diameter_mm. none: an addendum of one module. full: shortened "
              "by k = x₁ + x₂ − (a − a_d)/m modules (ISO 21771), which keeps the tip clearance of the basic rack.")
      .fallback("none", "the addendum of the basic rack");
}

void declare_planets(Declarations<StageInput>& stage) {
  stage.key("planets", &StageInput::planets, "Number of planets.").from(1, 50).required();
}

Declarations<MeshInput> declare_mesh(Declarations<MeshInput> t, const MeshKeys& keys) {
  t.optional();
  std::vector<Choice<StiffnessShape>> shapes = {{"computed", StiffnessShape::computed},
                                                {"constant", StiffnessShape::constant},
                                                {"harmonic", StiffnessShape::harmonic},
                                                {"rectangular", StiffnessShape::rectangular},
                                                {"table", StiffnessShape::table}};
  shapes.insert(shapes.end(), keys.more_shapes.begin(), keys.more_shapes.end());
  t.choice("stiffness", &MeshInput::stiffness, shapes,
           "Source of the mesh stiffness; every value except `computed` replaces the finite-element solution.")
      .required()
      .without_table("computed");
  t.key("mean_N_per_m", &MeshInput::mean, "Mean stiffness of one mesh, along the normal of its flanks.")
      .from(1e-3, 1e13)
      .needed_if(is("stiffness", {"constant", "harmonic", "rectangular"}));
  const std::vector<std::string> waves = {"harmonic", "rectangular"};
  auto with_ripple = waves;
  with_ripple.insert(with_ripple.end(), keys.more_waves.begin(), keys.more_waves.end());
  t.key("ripple", &MeshInput::ripple,
        "Relative ripple: k = mean (1 + ripple cos 2π phase), or mean (1 + ripple (s(phase) - duty)) with s = 1 during "
        "the fraction `duty` and else 0.")
      .from(0, 10)
      .required_if(is("stiffness", waves))
      .only_if(is("stiffness", with_ripple))
      .absent(keys.constant_shape);
  t.key("duty", &MeshInput::duty, "Fraction of the mesh cycle in which the rectangular wave is high.")
      .above(0, 1)
      .needed_if(is("stiffness", {"rectangular"}));
  t.key("phase", &MeshInput::phase, "Lag of this wave in mesh cycles, in addition to the phase from the geometry.")
      .from(-1, 1)
      .only_if(is("stiffness", with_ripple))
      .absent("no lag");
  t.key("half_backlash_um", &MeshInput::half_backlash, "Half the backlash of this mesh along the line of action.")
      .from(0, 1e4)
      .absent("that of [dynamics]");
  t.key("damping_ratio", &MeshInput::damping_ratio, "Damping ratio ζ of this mesh: c = 2ζ√(k m_e).")
      .from(0, 2)
      .absent("that of [dynamics]");
  t.key("file", &MeshInput::file,
        "Stiffness table (CSV); the path is relative to the scene. Either a table that annulus wrote, or columns of "
        "another program (docs/exchange.md): mesh_phase with stiffness_N_per_m, or with lte_um and load_N.")
      .needed_if(is("stiffness", {"table"}));
  return t;
}

}  // namespace annulus::app
