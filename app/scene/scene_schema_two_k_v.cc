#include "app/scene/scene_declare.h"
#include "app/scene/scene_schema.h"

namespace annulus::app {

void declare_two_k_v(std::vector<Table>& tables) {
  constexpr const char* needed = "needed by [dynamics]";
  const std::vector<StageKind> two_k_v = {StageKind::two_k_v};

  Declarations<CrankInput> crank("crank",
                                 "The crank shafts, one per planet: bearings of the output carrier hold them, their "
                                 "eccentrics carry the arc gears. planet.mass_kg is that of a planet with its shaft.",
                                 [](Scene& s, std::size_t) -> CrankInput& { return s.crank; });
  crank.only(two_k_v);
  crank.key("inertia_kg_m2", &CrankInput::inertia, "Moment of inertia of one shaft without its planet.")
      .from(least_inertia_kg_m2, 1e6)
      .absent(needed);
  crank.key("shaft_Nm_per_rad", &CrankInput::shaft, "Torsional stiffness of one shaft between planet and eccentrics.")
      .above(0, 1e14)
      .absent(needed);
  crank
      .key("bearing_N_per_m", &CrankInput::bearing,
           "Stiffness of one shaft's bearings in the carrier, along the circle of the cranks.")
      .above(0, 1e14)
      .absent(needed);
  crank
      .key("angle_deg", &CrankInput::angle,
           "Direction of the first arc gear's eccentric at time 0, from the line of centres to the first crank.")
      .fallback(0.0, "any start will do: the cranks turn through all angles")
      .from(-360, 360);
  tables.push_back(crank.done());

  Declarations<ArcGearInput> arc("arc_gear",
                                 "The gears with arc teeth on the eccentrics, with one tooth less than the housing has "
                                 "pins. Diameters, arc radius and width serve the contact formulas.",
                                 [](Scene& s, std::size_t) -> ArcGearInput& { return s.arc_gear; });
  arc.only(two_k_v);
  arc.key("count", &ArcGearInput::count, "Number of arc gears, equally spaced around the eccentrics.")
      .fallback(2L, "half a turn apart: their mass forces cancel")
      .from(1, 12);
  arc.key("pins", &ArcGearInput::pins, "Number of pins in the housing.").required().from(4, 1000);
  arc.key("eccentricity_mm", &ArcGearInput::eccentricity, "Eccentricity of the cranks.").required().above(0, 1000);
  arc.key("pin_circle_diameter_mm", &ArcGearInput::pin_circle_diameter, "Diameter of the circle of the pins' centres.")
      .above(0, 1e4)
      .absent("needed by a computed arc mesh");
  arc.key("pin_diameter_mm", &ArcGearInput::pin_diameter, "Diameter of a pin.")
      .above(0, 1e3)
      .absent("needed by a computed arc mesh");
  arc.key("arc_radius_mm", &ArcGearInput::arc_radius, "Radius of the concave arc of a tooth, on which a pin rolls.")
      .above(0, 1e4)
      .absent("needed by a computed arc mesh");
  arc.key("width_mm", &ArcGearInput::width, "Face width of one arc gear.")
      .above(0, 5000)
      .absent("needed by a computed arc mesh");
  arc.key("clearance_um", &ArcGearInput::clearance, "Material taken off the flanks along their normal, all around.")
      .fallback(0.0, "all pins on the loaded side touch at once, which the paper's formulas assume")
      .from(0, 1000);
  arc.choice("approach", &ArcGearInput::approach,
             {{"handbook", dynamics::LineApproach::handbook}, {"johnson", dynamics::LineApproach::johnson}},
             "Approach of pin and arc under load. handbook: Roark, 2/3 + ln(...), as the gear handbooks; johnson: "
             "Hertz pressure, depth to the centres of curvature.")
      .fallback(std::string("handbook"), "the formula of the paper");
  arc.key("mass_kg", &ArcGearInput::mass, "Mass of one arc gear.").from(lightest_kg, 1e6).absent(needed);
  arc.key("inertia_kg_m2", &ArcGearInput::inertia, "Moment of inertia of one arc gear about its axis.")
      .from(least_inertia_kg_m2, 1e6)
      .absent(needed);
  arc.key("bearing_N_per_m", &ArcGearInput::bearing,
          "Stiffness of an arc gear's bearing on one eccentric, any direction.")
      .above(0, 1e14)
      .absent(needed);
  tables.push_back(arc.done());

  Declarations<InputShaftInput> input("input", "The input shaft with what turns with it; it drives the sun.",
                                      [](Scene& s, std::size_t) -> InputShaftInput& { return s.input; });
  input.only(two_k_v).optional();
  input.key("inertia_kg_m2", &InputShaftInput::inertia, "Moment of inertia, motor included.")
      .from(least_inertia_kg_m2, 1e6)
      .absent(needed);
  input.key("shaft_Nm_per_rad", &InputShaftInput::shaft, "Torsional stiffness of the shaft between input and sun.")
      .above(0, 1e14)
      .absent(needed);
  input
      .key("support_Nm_per_rad", &InputShaftInput::support, "Torsional support of the input in the housing; inf: held.")
      .fallback(0.0, "free: it carries the power")
      .from(0, 1e14)
      .infinite();
  tables.push_back(input.done());

  Declarations<OutputInput> output("output", "The output: the carrier of the cranks, and its operating point.",
                                   [](Scene& s, std::size_t) -> OutputInput& { return s.output; });
  output.only(two_k_v);
  output.key("torque_Nm", &OutputInput::torque, "Load on the output.").required().above(0, 1e9);
  output.key("speed_rpm", &OutputInput::speed, "Speed of the output.").required().above(0, 1e6);
  output.key("inertia_kg_m2", &OutputInput::inertia, "Moment of inertia of the carrier and what turns with it.")
      .from(least_inertia_kg_m2, 1e6)
      .absent(needed);
  output
      .key("support_Nm_per_rad", &OutputInput::support,
           "Torsional support of the output, which turns steadily: inf: held to that motion, 0: free.")
      .required()
      .from(0, 1e14)
      .infinite();
  tables.push_back(output.done());
}

}  // namespace annulus::app
