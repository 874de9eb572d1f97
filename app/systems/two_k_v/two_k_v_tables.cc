#include "app/scene/gear_tables.h"
#include "app/systems/two_k_v/two_k_v_scene.h"

namespace annulus::app {

namespace {

Condition with_dynamics() { return given("[dynamics]"); }

/// A mesh that is computed, or computed besides its prescribed stiffness.
Condition computed_or_compared(const std::string& mesh) {
  return is(mesh + ".stiffness", {"computed"}) || is(mesh + ".compare", {"computed"});
}

Table two_k_v_stage_table() {
  Declarations<StageInput> stage("stage", "", [](Scene& s, std::size_t) -> StageInput& { return s.stage; });
  declare_planets(stage);
  return stage.done();
}

/// The sun only turns: it has no mass.
Table turning_sun_table() {
  Declarations<HubGearInput> sun("sun", "The sun gear.", [](Scene& s, std::size_t) -> HubGearInput& { return s.sun; });
  declare_teeth(sun, Flanks::external);
  declare_inertia(sun).required_if(with_dynamics());
  declare_flanks(sun, Flanks::external);
  declare_bore(sun, computed_or_compared("mesh.sun_planet"));
  return sun.done();
}

Table crank_planet_table() {
  Declarations<HubGearInput> planet("planet", "Each planet gear.",
                                    [](Scene& s, std::size_t) -> HubGearInput& { return s.planet; });
  declare_teeth(planet, Flanks::external);
  declare_mass(planet);
  declare_inertia(planet).required_if(with_dynamics());
  declare_flanks(planet, Flanks::external);
  declare_bore(planet, computed_or_compared("mesh.sun_planet"));
  return planet.done();
}

Table crank_table() {
  Declarations<CrankInput> crank("crank",
                                 "The crank shafts, one per planet: bearings of the output carrier hold them, their "
                                 "eccentrics carry the arc gears. planet.mass_kg is that of a planet with its shaft.",
                                 [](Scene& s, std::size_t) -> CrankInput& { return s.crank; });
  crank.key("inertia_kg_m2", &CrankInput::inertia, "Moment of inertia of one shaft without its planet.")
      .from(least_inertia_kg_m2, 1e6)
      .required_if(with_dynamics());
  crank.key("shaft_Nm_per_rad", &CrankInput::shaft, "Torsional stiffness of one shaft between planet and eccentrics.")
      .above(0, 1e14)
      .required_if(with_dynamics());
  crank
      .key("bearing_N_per_m", &CrankInput::bearing,
           "Stiffness of one shaft's bearings in the carrier, along the circle of the cranks.")
      .above(0, 1e14)
      .required_if(with_dynamics());
  crank
      .key("angle_deg", &CrankInput::angle,
           "Direction of the first arc gear's eccentric at time 0, from the line of centres to the first crank.")
      .fallback(0.0, "any start will do: the cranks turn through all angles")
      .from(-360, 360);
  return crank.done();
}

Table arc_gear_table() {
  Declarations<ArcGearInput> arc("arc_gear",
                                 "The gears with arc teeth on the eccentrics, with one tooth less than the housing has "
                                 "pins. Diameters, arc radius and width serve the contact formulas.",
                                 [](Scene& s, std::size_t) -> ArcGearInput& { return s.arc_gear; });
  const auto computed_arc = computed_or_compared("mesh.arc_pins");
  constexpr const char* arc_why = "or prescribe the stiffness of the mesh in [mesh.arc_pins]";
  arc.key("count", &ArcGearInput::count, "Number of arc gears, equally spaced around the eccentrics.")
      .fallback(2L, "half a turn apart: their mass forces cancel")
      .from(1, 12);
  arc.key("pins", &ArcGearInput::pins, "Number of pins in the housing.").required().from(4, 1000);
  arc.key("eccentricity_mm", &ArcGearInput::eccentricity, "Eccentricity of the cranks.").required().above(0, 1000);
  arc.key("pin_circle_diameter_mm", &ArcGearInput::pin_circle_diameter, "Diameter of the circle of the pins' centres.")
      .above(0, 1e4)
      .required_if(computed_arc, arc_why);
  arc.key("pin_diameter_mm", &ArcGearInput::pin_diameter, "Diameter of a pin.")
      .above(0, 1e3)
      .required_if(computed_arc, arc_why);
  arc.key("arc_radius_mm", &ArcGearInput::arc_radius, "Radius of the concave arc of a tooth, on which a pin rolls.")
      .above(0, 1e4)
      .required_if(computed_arc, arc_why);
  arc.key("width_mm", &ArcGearInput::width, "Face width of one arc gear.")
      .above(0, 5000)
      .required_if(computed_arc, arc_why);
  arc.key("clearance_um", &ArcGearInput::clearance, "Material taken off the flanks along their normal, all around.")
      .only_if(computed_arc, "a prescribed stiffness has half_backlash_um")
      .fallback(0.0, "all pins on the loaded side touch at once, which the paper's formulas assume")
      .from(0, 1000);
  arc.choice("approach", &ArcGearInput::approach,
             {{"handbook", dynamics::LineApproach::handbook}, {"johnson", dynamics::LineApproach::johnson}},
             "Approach of pin and arc under load. handbook: Roark, 2/3 + ln(...), as the gear handbooks; johnson: "
             "Hertz pressure, depth to the centres of curvature.")
      .fallback(std::string("handbook"), "the formula of the paper");
  arc.key("mass_kg", &ArcGearInput::mass, "Mass of one arc gear.").from(lightest_kg, 1e6).required_if(with_dynamics());
  arc.key("inertia_kg_m2", &ArcGearInput::inertia, "Moment of inertia of one arc gear about its axis.")
      .from(least_inertia_kg_m2, 1e6)
      .required_if(with_dynamics());
  arc.key("bearing_N_per_m", &ArcGearInput::bearing,
          "Stiffness of an arc gear's bearing on one eccentric, any direction.")
      .above(0, 1e14)
      .required_if(with_dynamics());
  return arc.done();
}

Table input_shaft_table() {
  Declarations<InputShaftInput> input("input", "The input shaft with what turns with it; it drives the sun.",
                                      [](Scene& s, std::size_t) -> InputShaftInput& { return s.input; });
  input.optional();
  input.key("inertia_kg_m2", &InputShaftInput::inertia, "Moment of inertia, motor included.")
      .from(least_inertia_kg_m2, 1e6)
      .required_if(with_dynamics(), "with the ratio squared it sets the lowest frequency");
  input.key("shaft_Nm_per_rad", &InputShaftInput::shaft, "Torsional stiffness of the shaft between input and sun.")
      .above(0, 1e14)
      .required_if(with_dynamics());
  input
      .key("support_Nm_per_rad", &InputShaftInput::support,
           "Torsional support of the input in the housing; inf: fixed.")
      .fallback(0.0, "free: it carries the power")
      .from(0, 1e14)
      .infinite();
  return input.done();
}

Table output_table() {
  Declarations<OutputInput> output("output", "The output: the carrier of the cranks, and its operating point.",
                                   [](Scene& s, std::size_t) -> OutputInput& { return s.output; });
  output.key("torque_Nm", &OutputInput::torque, "Load on the output.").required().above(0, 1e9);
  output.key("speed_rpm", &OutputInput::speed, "Speed of the output.").required().above(0, 1e6);
  output.key("inertia_kg_m2", &OutputInput::inertia, "Moment of inertia of the carrier and what turns with it.")
      .from(least_inertia_kg_m2, 1e6)
      .required_if(with_dynamics());
  output
      .key("support_Nm_per_rad", &OutputInput::support,
           "Torsional support of the output, which turns steadily: inf: bound to that motion, 0: free.")
      .required()
      .from(0, 1e14)
      .infinite();
  return output.done();
}

Table comparable_mesh_table(const char* path, const char* meaning, MeshInput& (*section)(Scene&, std::size_t)) {
  auto mesh = declare_mesh(path, meaning, section);
  mesh.choice("compare", &MeshInput::compare, {{"none", Compare::none}, {"computed", Compare::computed}},
              "Also compute the stiffness of a mesh with a prescribed one: the report shows all results with both.")
      .only_if(!is("stiffness", {"computed"}), "this mesh is computed anyway")
      .fallback(std::string("none"), "the prescribed stiffness alone");
  return mesh.done();
}

}  // namespace

std::vector<Table> two_k_v_tables() {
  return {two_k_v_stage_table(),
          turning_sun_table(),
          crank_planet_table(),
          crank_table(),
          arc_gear_table(),
          input_shaft_table(),
          output_table(),
          comparable_mesh_table("mesh.sun_planet", "Stiffness of the sun mesh, prescribed instead of computed.",
                                [](Scene& s, std::size_t) -> MeshInput& { return s.sun_planet; }),
          comparable_mesh_table(
              "mesh.arc_pins",
              "Stiffness of the arc teeth on their pins, prescribed instead of computed by the contact formulas.",
              [](Scene& s, std::size_t) -> MeshInput& { return s.arc_pins; })};
}

}  // namespace annulus::app
