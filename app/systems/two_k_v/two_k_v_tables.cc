#include "app/scene/gear_tables.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/shared/sun_planet_input.h"
#include "app/systems/two_k_v/two_k_v_input.h"
#include "app/systems/two_k_v/two_k_v_scene.h"

namespace annulus::app {

namespace {

Condition with_dynamics() { return given("[dynamics]"); }

/// A stiffness that the lumped model needs.
template <class Section>
void declare_stiffness(Declarations<Section>& t, const char* name, std::optional<double> Section::*member,
                       const char* meaning) {
  t.key(name, member, meaning).above(0, 1e14).required_if(with_dynamics()).often_assumed();
}

template <class Section>
Declared declare_damping(Declarations<Section>& t, const char* name, std::optional<double> Section::*member,
                         const std::string& of) {
  return t.key(name, member, "Damping ratio of " + of + ".")
      .from(0, 2)
      .only_if(with_dynamics())
      .absent("dynamics.support_damping_ratio");
}

/// A mesh that is computed, or computed besides its prescribed stiffness.
Condition computed_or_compared(const std::string& mesh) {
  return is(mesh + ".stiffness", {"computed"}) || is(mesh + ".compare", {"computed"});
}

Table two_k_v_stage_table() {
  Declarations stage("stage", "", &Scene::stage);
  declare_planets(stage);
  return stage.done();
}

enum class Mass { none, own };

Table turning_gear_table(const char* path, const char* meaning, HubGearInput SunPlanetInput::*member, Mass mass) {
  Declarations gear(path, meaning, member);
  declare_teeth(gear, Flanks::external);
  if (mass == Mass::own) declare_mass(gear);
  declare_inertia(gear).required_if(with_dynamics());
  declare_own_face(gear);
  declare_own_material(gear);
  declare_flanks(gear, Flanks::external);
  declare_bore(gear, computed_or_compared("mesh.sun_planet"));
  return gear.done();
}

Table crank_table() {
  Declarations crank("crank",
                     "The crank shafts, one per planet. They turn in bearings of the output carrier; their eccentrics "
                     "carry the arc gears. planet.mass_kg is the mass of a planet with its shaft.",
                     &TwoKVInput::crank);
  declare_inertia(crank, "Moment of inertia of one shaft without its planet.")
      .required_if(with_dynamics())
      .often_assumed();
  declare_stiffness(crank, "shaft_Nm_per_rad", &CrankInput::shaft,
                    "Torsional stiffness of one shaft between planet and eccentrics.");
  declare_stiffness(crank, "bearing_N_per_m", &CrankInput::bearing,
                    "Stiffness of one shaft's bearings in the carrier, along the circle of the cranks.");
  declare_damping(crank, "shaft_damping_ratio", &CrankInput::shaft_damping, "the shafts between planet and eccentrics");
  declare_damping(crank, "bearing_damping_ratio", &CrankInput::bearing_damping, "the bearings in the carrier")
      .often_assumed();
  crank
      .key("angle_deg", &CrankInput::angle,
           "Direction of the first arc gear's eccentric at time 0, from the line of centres to the first crank.")
      .fallback(0.0, "any angle: the cranks turn through all angles")
      .from(-360, 360);
  return crank.done();
}

Table arc_gear_table() {
  Declarations arc("arc_gear",
                   "The gears with arc teeth on the eccentrics. They have one tooth less than the housing has pins. "
                   "The contact formulas need the diameters, the arc radius and the width.",
                   &TwoKVInput::arc_gear);
  const auto computed_arc = computed_or_compared("mesh.arc_pins");
  arc.key("count", &ArcGearInput::count, "Number of arc gears, equally spaced around the eccentrics.")
      .fallback(2, "half a turn apart: their mass forces cancel")
      .from(1, 12);
  arc.key("pins", &ArcGearInput::pins, "Number of pins in the housing.").required().from(4, 1000);
  arc.key("eccentricity_mm", &ArcGearInput::eccentricity, "Eccentricity of the cranks.").required().above(0, 1000);
  const auto length = [&](const char* name, std::optional<double> ArcGearInput::*member, double most,
                          const char* meaning) {
    arc.key(name, member, meaning)
        .above(0, most)
        .required_if(computed_arc, "or prescribe the stiffness of the mesh in [mesh.arc_pins]");
  };
  length("pin_circle_diameter_mm", &ArcGearInput::pin_circle_diameter, 1e4,
         "Diameter of the circle through the centres of the pins.");
  length("pin_diameter_mm", &ArcGearInput::pin_diameter, 1e3, "Diameter of a pin.");
  length("arc_radius_mm", &ArcGearInput::arc_radius, 1e4,
         "Radius of the concave arc of a tooth, on which a pin rolls.");
  length("width_mm", &ArcGearInput::width, 5000, "Face width of one arc gear.");
  arc.key("clearance_um", &ArcGearInput::clearance, "Material removed from all flanks along their normal.")
      .only_if(computed_arc, "a prescribed stiffness has half_backlash_um")
      .fallback(0.0, "all pins on the loaded side touch at once, as the formulas of the paper assume")
      .from(0, 1000);
  arc.choice("approach", &ArcGearInput::approach,
             {{"handbook", dynamics::LineApproach::handbook}, {"johnson", dynamics::LineApproach::johnson}},
             "Formula for the approach of pin and arc under load. handbook: Roark, 2/3 + ln(...), as in gear "
             "handbooks; johnson: Hertz pressure, with the depth to the centres of curvature.")
      .fallback("handbook", "the formula of the paper");
  declare_mass(arc, "Mass of one arc gear.").often_assumed();
  declare_inertia(arc, "Moment of inertia of one arc gear about its axis.")
      .required_if(with_dynamics())
      .often_assumed();
  declare_stiffness(arc, "bearing_N_per_m", &ArcGearInput::bearing,
                    "Stiffness of an arc gear's bearing on one eccentric, any direction.");
  declare_damping(arc, "bearing_damping_ratio", &ArcGearInput::bearing_damping, "these bearings").often_assumed();
  return arc.done();
}

Table input_shaft_table() {
  Declarations input("input", "The input shaft with all parts that turn with it; it drives the sun.",
                     &TwoKVInput::input);
  input.optional();
  declare_inertia(input, "Moment of inertia, motor included.")
      .required_if(with_dynamics(), "times the ratio squared it determines the lowest frequency")
      .often_assumed();
  declare_stiffness(input, "shaft_Nm_per_rad", &InputShaftInput::shaft,
                    "Torsional stiffness of the shaft between input and sun.");
  input
      .key("support_Nm_per_rad", &InputShaftInput::support,
           "Torsional support of the input in the housing; inf: fixed.")
      .fallback(0.0, "free: it transmits the power")
      .from(0, 1e14)
      .infinite()
      .often_assumed();
  declare_damping(input, "damping_ratio", &InputShaftInput::damping, "its shaft and its support");
  return input.done();
}

Table output_table() {
  Declarations output("output", "The output: the carrier of the cranks, and its operating point.", &TwoKVInput::output);
  output.key("torque_Nm", &OutputInput::torque, "Load on the output.").required().above(0, 1e9);
  output.key("speed_rpm", &OutputInput::speed, "Speed of the output.").required().above(0, 1e6);
  declare_inertia(output, "Moment of inertia of the carrier and all parts that turn with it.")
      .required_if(with_dynamics())
      .often_assumed();
  output
      .key("support_Nm_per_rad", &OutputInput::support,
           "Torsional support of the output against its steady rotation; inf: fixed to this rotation, 0: free.")
      .required()
      .from(0, 1e14)
      .infinite()
      .often_assumed();
  declare_damping(output, "damping_ratio", &OutputInput::damping, "its support");
  return output.done();
}

Table compare_key(const char* mesh_table, Compare TwoKVInput::*member) {
  Declarations<TwoKVInput> mesh(mesh_table, "");
  mesh.choice("compare", member, {{"none", Compare::none}, {"computed", Compare::computed}},
              "Whether a prescribed stiffness is also computed; the report then shows all results with both.")
      .only_if(!is("stiffness", {"computed"}), "this mesh is computed anyway")
      .fallback("none", "the prescribed stiffness alone");
  return mesh.done();
}

}  // namespace

std::vector<Table> two_k_v_tables() {
  return {
      two_k_v_stage_table(),
      turning_gear_table("sun", "The sun gear.", &SunPlanetInput::sun, Mass::none),  // it only turns
      turning_gear_table("planet", "Each planet gear.", &SunPlanetInput::planet, Mass::own),
      crank_table(),
      arc_gear_table(),
      input_shaft_table(),
      output_table(),
      rotor_table(),
      declare_mesh({"mesh.sun_planet", "Stiffness of the sun mesh, prescribed instead of computed.",
                    &SunPlanetInput::sun_planet})
          .done(),
      compare_key("mesh.sun_planet", &TwoKVInput::compare_sun_planet),
      declare_mesh({"mesh.arc_pins",
                    "Stiffness of the arc teeth on their pins, prescribed instead of computed by the contact formulas.",
                    &TwoKVInput::arc_pins})
          .done(),
      compare_key("mesh.arc_pins", &TwoKVInput::compare_arc_pins)};
}

}  // namespace annulus::app
