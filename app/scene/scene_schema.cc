#include "app/scene/scene_schema.h"

#include "app/scene/scene_declare.h"

namespace annulus::app {

namespace {

/// A turn in two years; powers divided by less are no torques.
constexpr double slowest_rpm = 1e-6;

constexpr const char* needs_dynamics = "needed by [dynamics]";
const std::vector<StageKind> with_planets = {StageKind::planetary, StageKind::two_k_v};

template <class Section>
void declare_gear(Declarations<Section>& t, bool internal) {
  t.key("teeth", &Section::teeth, "Number of teeth.").required().from(5, 2000);
  t.key("profile_shift", &Section::profile_shift,
        internal ? "Profile shift in modules; positive moves the tooth space outwards."
                 : "Profile shift in modules; positive moves the rack outwards.")
      .required()
      .from(-2, 3);
  t.key("mass_kg", &Section::mass, "Mass.").from(lightest_kg, 1e6).absent(needs_dynamics);
  t.key("inertia_kg_m2", &Section::inertia, "Moment of inertia about the axis.")
      .from(least_inertia_kg_m2, 1e6)
      .absent(needs_dynamics);
  t.key("tip_diameter_mm", &Section::tip_diameter, "Tip diameter.")
      .above(0, 1e5)
      .absent("addendum of one module beyond the profile shift (ISO 53)");
  t.key("root_diameter_mm", &Section::root_diameter, "Root diameter.")
      .above(0, 1e5)
      .absent("dedendum of 1.25 modules beyond the profile shift (ISO 53)");
  t.key("root_fillet_factor", &Section::root_fillet_factor,
        internal ? "Radius of the root fillet in modules; limited to the full circle between the flanks."
                 : "Tip radius of the generating rack in modules.")
      .fallback(0.38, "ISO 53 profile A")
      .above(0, 0.6);
  t.key("tip_relief_um", &Section::tip_relief, "Linear tip relief, normal to the flank.")
      .fallback(0.0, "unmodified flanks")
      .from(0, 1000);
  t.key("tip_relief_length_mm", &Section::tip_relief_length, "Length of the tip relief along the line of action.")
      .fallback(0.0, "unmodified flanks")
      .from(0, 1000);
  t.key("profile_crowning_um", &Section::profile_crowning, "Parabolic crowning at both ends of the flank's profile.")
      .fallback(0.0, "unmodified flanks")
      .from(0, 1000);
  t.key("lead_crowning_um", &Section::lead_crowning,
        "Parabolic crowning along the face width, removed at both ends. The mesh becomes solid.")
      .fallback(0.0, "unmodified flanks")
      .from(0, 1000);
  t.key("lead_slope_um", &Section::lead_slope,
        "Slope along the face width, end to end; positive removes material towards +z, the free end of a thin_walled "
        "ring. The mesh becomes solid.")
      .fallback(0.0, "unmodified flanks")
      .from(-1000, 1000);
}

const std::vector<StageKind> planetary = {StageKind::planetary}, pair_alone = {StageKind::helical_pair},
                             planetary_and_pair = {StageKind::planetary, StageKind::helical_pair};

}  // namespace

Table hub_gear_table(const char* path, const char* meaning, const std::vector<StageKind>& kinds,
                     HubGearInput& (*section)(Scene&, std::size_t)) {
  Declarations<HubGearInput> t(path, meaning, section);
  t.only(kinds);
  declare_gear(t, false);
  t.key("bore_diameter_mm", &HubGearInput::bore_diameter, "Diameter of the bore, where the body meets a rigid hub.")
      .above(0, 1e5)
      .absent("needed when a mesh of this gear is computed");
  return t.done();
}

Table mesh_table(const char* path, const char* meaning, const std::vector<StageKind>& kinds,
                 MeshInput& (*section)(Scene&, std::size_t)) {
  Declarations<MeshInput> t(path, meaning, section);
  t.optional().only(kinds);
  std::vector<Choice<StiffnessShape>> shapes = {{"computed", StiffnessShape::computed},
                                                {"constant", StiffnessShape::constant},
                                                {"harmonic", StiffnessShape::harmonic},
                                                {"rectangular", StiffnessShape::rectangular},
                                                {"table", StiffnessShape::table}};
  if (kinds == pair_alone) {
    shapes.push_back({"iso_6336", StiffnessShape::iso_6336});
    shapes.push_back({"closed_form", StiffnessShape::closed_form});
  }
  t.choice("stiffness", &MeshInput::stiffness, shapes,
           "Where the mesh stiffness comes from; everything but `computed` replaces the finite-element solve.")
      .required();
  t.choice("compare", &MeshInput::compare, {{"none", Compare::none}, {"computed", Compare::computed}},
           "Also compute the stiffness of a mesh that is given: the report shows what the computed one makes of all "
           "figures.")
      .fallback(std::string("none"), "the given stiffness alone")
      .only({StageKind::two_k_v});
  t.key("mean_N_per_m", &MeshInput::mean, "Mean stiffness of one mesh.")
      .from(1e-3, 1e13)
      .absent("needed by all given shapes but a table");
  t.key("ripple", &MeshInput::ripple,
        "Relative ripple: k = mean (1 + ripple cos 2π phase), or mean (1 + ripple (s(phase) - duty)) with s = 1 during "
        "the fraction `duty` and else 0.")
      .from(0, 10)
      .absent("needed by harmonic and rectangular");
  t.key("duty", &MeshInput::duty, "Fraction of the mesh cycle in which the rectangular wave is high.")
      .above(0, 1)
      .absent("needed by rectangular");
  t.key("phase", &MeshInput::phase, "Lag of this wave in mesh cycles, on top of the phasing derived from the geometry.")
      .from(-1, 1)
      .absent("no lag");
  t.key("half_backlash_um", &MeshInput::half_backlash, "Half the backlash of this mesh along the line of action.")
      .from(0, 1e4)
      .absent("that of [dynamics]");
  t.key("file", &MeshInput::file,
        "Stiffness table (CSV), relative to the scene: one that annulus wrote, or columns of another program "
        "(docs/exchange.md): "
        "mesh_phase and stiffness_N_per_m, or lte_um and load_N.")
      .absent("needed by table");
  return t.done();
}

namespace {

std::vector<Table> declare_tables() {
  std::vector<Table> tables;

  Declarations<Scene> top("", "The whole scene.", [](Scene& s, std::size_t) -> Scene& { return s; });
  top.key("title", &Scene::title, "Title of the report.").fallback(std::string("Planetary stage"), "");
  top.key("accuracy", &Scene::accuracy, "Wanted relative accuracy of the mesh stiffness.")
      .fallback(0.01, "well below the spread of unknown inputs such as support stiffnesses")
      .from(1e-5, 0.2);
  top.choice(
         "model", &Scene::fidelity,
         {{"automatic", Fidelity::automatic},
          {"closed_form", Fidelity::closed_form},
          {"plane", Fidelity::plane},
          {"solid", Fidelity::solid},
          {"resolved", Fidelity::resolved}},
         "Kind of model of the elastic bodies: closed_form, tooth and curved-beam formulas, seconds, its error is "
         "not controlled; plane or solid, finite elements with condensed flanks; resolved, the contact patch itself "
         "is meshed, plane or solid as the scene requires.")
      .fallback(std::string("automatic"), "the cheapest with a controlled error that the scene permits");
  top.key("reference", &Scene::reference, "File of published values to compare with, relative to the scene.")
      .absent("no comparison");
  tables.push_back(top.done());

  Declarations<StageInput> stage("stage", "The gear set and its operating point.",
                                 [](Scene& s, std::size_t) -> StageInput& { return s.stage; });
  stage
      .choice("kind", &StageInput::kind,
              {{"planetary", StageKind::planetary},
               {"helical_pair", StageKind::helical_pair},
               {"two_k_v", StageKind::two_k_v}},
              "Kind of stage.")
      .required();
  stage.key("planets", &StageInput::planets, "Number of planets.").from(1, 50).required().only(with_planets);
  stage
      .key("planet_angles_deg", &StageInput::planet_angles,
           "Places of the planets, one per planet, counter-clockwise from the first, which stands at 0; two decimals "
           "are enough. A planet fits between the teeth of sun and ring every 360° / (teeth of the sun + teeth of "
           "the ring).")
      .from(0, 360)
      .only(planetary)
      .absent("equally spaced");
  stage.key("module_mm", &StageInput::module, "Module.").required().from(0.05, 100);
  stage.key("pressure_angle_deg", &StageInput::pressure_angle, "Pressure angle of the basic rack.")
      .required()
      .from(10, 35);
  stage
      .key("helix_angle_deg", &StageInput::helix_angle,
           "Helix angle at the reference circle; positive: planets, ring and pinion right-handed, sun and wheel "
           "left-handed. The "
           "module, "
           "pressure angle and profile shifts are then those of the normal section; forces and transmission errors "
           "of a planetary stage those of the transverse one.")
      .fallback(0.0, "spur gears")
      .from(-45, 45);
  stage.key("face_width_mm", &StageInput::face_width, "Common face width.").required().above(0, 5000);
  stage
      .key("centre_distance_mm", &StageInput::centre_distance,
           "Working centre distance of sun and planet, or of pinion and wheel.")
      .above(0, 1e5)
      .required_for(planetary)
      .only(planetary_and_pair)
      .absent("that without backlash, from the profile shifts");
  stage.key("power_kW", &StageInput::power, "Transmitted power; the sun drives, the carrier is driven.")
      .above(0, 1e6)
      .required()
      .only(planetary);
  stage.key("sun_speed_rpm", &StageInput::sun_speed, "Speed of the sun; give this or carrier_speed_rpm.")
      .from(slowest_rpm, 1e6)
      .only(planetary)
      .absent("follows from carrier_speed_rpm");
  stage.key("carrier_speed_rpm", &StageInput::carrier_speed, "Speed of the carrier; give this or sun_speed_rpm.")
      .from(slowest_rpm, 1e6)
      .only(planetary)
      .absent("follows from sun_speed_rpm");
  stage
      .key("pinion_torque_Nm", &StageInput::pinion_torque,
           "Torque that drives the pinion. Negative: the back flanks carry it.")
      .from(-1e9, 1e9)
      .required()
      .only(pair_alone);
  stage.key("pinion_speed_rpm", &StageInput::pinion_speed, "Speed of the pinion.")
      .above(0, 1e6)
      .required()
      .only(pair_alone);
  tables.push_back(stage.done());

  Declarations<MaterialInput> material("material", "Material of all gears.",
                                       [](Scene& s, std::size_t) -> MaterialInput& { return s.material; });
  material.key("youngs_modulus_GPa", &MaterialInput::youngs_modulus, "Young's modulus.").required().from(1e-6, 2000);
  material.key("poisson_ratio", &MaterialInput::poisson_ratio, "Poisson's ratio.")
      .fallback(0.3, "steel")
      .from(0, 0.4999);
  material.key("density_kg_per_m3", &MaterialInput::density, "Density; only used to check masses.")
      .fallback(7850.0, "steel")
      .from(100, 30000);
  tables.push_back(material.done());

  tables.push_back(hub_gear_table("sun", "The sun gear.", with_planets,
                                  [](Scene& s, std::size_t) -> HubGearInput& { return s.sun; }));
  tables.push_back(hub_gear_table("planet", "Each planet gear.", with_planets,
                                  [](Scene& s, std::size_t) -> HubGearInput& { return s.planet; }));

  Declarations<CarrierInput> carrier("carrier", "The planet carrier.",
                                     [](Scene& s, std::size_t) -> CarrierInput& { return s.carrier; });
  carrier.optional().only(planetary);
  carrier.key("mass_kg", &CarrierInput::mass, "Mass without planets.").from(lightest_kg, 1e6).absent(needs_dynamics);
  carrier.key("inertia_kg_m2", &CarrierInput::inertia, "Moment of inertia about the axis, without planets.")
      .from(least_inertia_kg_m2, 1e6)
      .absent(needs_dynamics);
  tables.push_back(carrier.done());
  declare_two_k_v(tables);

  Declarations<RingInput> ring("ring", "A ring gear and what holds it; several rings are compared with each other.",
                               [](Scene& s, std::size_t i) -> RingInput& { return s.rings.at(i); });
  ring.repeated([](Scene& s, std::size_t n) { s.rings.resize(n); }).only(planetary);
  ring.key("name", &RingInput::name, "Name, also of the folder of its results.").required();
  ring.choice(
          "structure", &RingInput::structure,
          {{"traditional", Structure::traditional},
           {"thin_walled", Structure::thin_walled},
           {"pinned", Structure::pinned},
           {"bolted", Structure::bolted},
           {"splined", Structure::splined},
           {"clamped", Structure::clamped}},
          "traditional: outer surface held, or a bolted flange if one is given; thin_walled: cantilever on a "
          "sleeve whose end face is held, outside free, with a hoop if one is given; pinned: pins around the "
          "outside that carry outward pressure only; bolted: the same places held both ways; splined: spline "
          "teeth around the outside in a rigid mate; clamped: both end faces held by a bolt circle through the rim, "
          "outside free.")
      .required();
  declare_gear(ring, true);
  ring.key("outside_diameter_mm", &RingInput::outside_diameter, "Outside diameter; give this or rim_thickness_mm.")
      .above(0, 1e5)
      .absent("root diameter plus twice rim_thickness_mm");
  ring.key("rim_thickness_mm", &RingInput::rim_thickness, "From the root circle to the outside.")
      .above(0, 1e4)
      .absent("follows from outside_diameter_mm");
  ring.key("flange_width_mm", &RingInput::flange_width,
           "traditional: axial width of a toothless flange at the lower end of the ring, held by its end face.")
      .above(0, 5000)
      .absent("no flange: the outer surface is held");
  ring.key("flange_diameter_mm", &RingInput::flange_diameter, "traditional: outside diameter of the flange.")
      .above(0, 1e5)
      .absent("no flange: the outer surface is held");
  ring.key("free_length_mm", &RingInput::free_length,
           "thin_walled: toothless sleeve between the held face and the teeth; 0: the teeth start at the held face.")
      .from(0, 1e4)
      .absent("thin_walled only");
  ring.key("sleeve_thickness_mm", &RingInput::sleeve_thickness,
           "thin_walled: thickness of the sleeve, at the outside diameter.")
      .above(0, 1e4)
      .absent("thin_walled only");
  ring.key("hoop_width_mm", &RingInput::hoop_width, "thin_walled: axial width of a stiffening hoop at the free end.")
      .above(0, 1e4)
      .absent("no hoop");
  ring.key("hoop_thickness_mm", &RingInput::hoop_thickness,
           "thin_walled: radial thickness of the hoop, beyond the outside diameter.")
      .above(0, 1e4)
      .absent("no hoop");
  ring.key("pins", &RingInput::pins,
           "pinned, bolted: number of equally spaced pins or bolts; give this or pin_angles_deg.")
      .from(1, 2000)
      .absent("pinned and bolted only");
  ring.key("pin_angles_deg", &RingInput::pin_angles,
           "pinned, bolted: place of every pin, counter-clockwise from the centre of tooth 0; give this or pins.")
      .from(-360, 360)
      .longest(2000)
      .absent("equally spaced");
  ring.key("first_pin_angle_deg", &RingInput::first_pin_angle,
           "pinned, bolted: first of equally spaced pins, from the centre of tooth 0.")
      .from(-360, 360)
      .absent("0: behind tooth 0");
  ring.key("pin_diameter_mm", &RingInput::pin_diameter, "pinned, bolted: diameter.")
      .above(0, 1000)
      .absent("pinned and bolted only");
  ring.key("pin_clearance_um", &RingInput::pin_clearance, "pinned: radial play.").from(0, 1e4).absent("0: no play");
  ring.key("pin_radial_stiffness_N_per_m", &RingInput::pin_radial_stiffness,
           "pinned, bolted: radial stiffness of one pin.")
      .above(0, 1e14)
      .absent("derived from the pin");
  ring.key("pin_tangential_stiffness_N_per_m", &RingInput::pin_tangential_stiffness,
           "pinned, bolted: tangential stiffness of one pin.")
      .above(0, 1e14)
      .absent("as the radial one");
  ring.key("pin_free_span_mm", &RingInput::pin_free_span,
           "pinned, bolted: length of pin between ring and housing, where it bends and shears.")
      .from(0, 1000)
      .absent("0: no bending of the pin");
  ring.key("housing_clearance_um", &RingInput::housing_clearance,
           "pinned, bolted: radial play of the rim in a rigid housing bore, on which it can rest; absent: no bore.")
      .from(0, 1e4)
      .absent("no bore; 0 with a single pin, which cannot hold the ring alone");
  ring.key("splines", &RingInput::splines, "splined: number of spline teeth around the outside.")
      .from(3, 2000)
      .absent("splined only");
  ring.key("first_spline_angle_deg", &RingInput::first_spline_angle,
           "splined: centre of the first spline tooth, from the centre of tooth 0.")
      .from(-360, 360)
      .absent("0: behind tooth 0");
  ring.key("spline_flank_angle_deg", &RingInput::spline_flank_angle,
           "splined: angle between a spline flank and the radius, at the outside diameter.")
      .from(0, 60)
      .absent("30, the pressure angle of ISO 4156");
  ring.key("spline_clearance_um", &RingInput::spline_clearance, "splined: play of each flank, normal to it.")
      .from(0, 1e4)
      .absent("0: no play");
  ring.key("spline_stiffness_N_per_m", &RingInput::spline_stiffness, "splined: normal stiffness of one flank.")
      .above(0, 1e14)
      .absent("derived from the spline tooth");
  ring.key("clamp_inner_diameter_mm", &RingInput::clamp_inner_diameter,
           "clamped: both end faces are held from here out to the outside diameter; the rest of them is free.")
      .above(0, 1e5)
      .absent("clamped only");
  ring.key("bolts", &RingInput::bolts, "clamped: number of equally spaced bolts through the rim.")
      .from(3, 2000)
      .absent("clamped only");
  ring.key("bolt_circle_diameter_mm", &RingInput::bolt_circle_diameter, "clamped: diameter of the bolt circle.")
      .above(0, 1e5)
      .absent("clamped only");
  ring.key("bolt_diameter_mm", &RingInput::bolt_diameter, "clamped: diameter of the bolt holes.")
      .above(0, 1000)
      .absent("clamped only");
  ring.key("first_bolt_angle_deg", &RingInput::first_bolt_angle, "clamped: first bolt, from the centre of tooth 0.")
      .from(-360, 360)
      .absent("0: behind tooth 0");
  ring.key("dowels", &RingInput::dowels, "clamped: number of dowels on the bolt circle, between bolts.")
      .from(1, 2000)
      .absent("no dowels");
  ring.key("dowel_diameter_mm", &RingInput::dowel_diameter, "clamped: diameter of the dowels.")
      .above(0, 1000)
      .absent("no dowels");
  tables.push_back(ring.done());

  Declarations<ErrorInput> errors(
      "errors", "Manufacturing errors. Lists have one value per planet. Eccentricities turn with their body.",
      [](Scene& s, std::size_t) -> ErrorInput& { return s.errors; });
  errors.optional().only(planetary_and_pair);
  const auto list = [&](const char* name, std::vector<double> ErrorInput::*member, const char* meaning, double limit) {
    errors.key(name, member, meaning)
        .fallback(std::vector<double>{}, "0 for every planet")
        .from(-limit, limit)
        .only(planetary);
  };
  const auto single = [&](const char* name, double ErrorInput::*member, const char* meaning, double limit) {
    errors.key(name, member, meaning).fallback(0.0, "no error").from(-limit, limit).only(planetary);
  };
  list("planet_eccentricity_um", &ErrorInput::planet_eccentricity, "Eccentricity of each planet.", 1e4);
  list("planet_eccentricity_phase_deg", &ErrorInput::planet_eccentricity_phase,
       "Direction of the eccentricity at time 0, in the planet's own frame.", 360);
  list("planet_installation_um", &ErrorInput::planet_installation, "Misplacement of each planet's bearing.", 1e4);
  list("planet_installation_phase_deg", &ErrorInput::planet_installation_phase,
       "Direction of the misplacement, in the frame of the carrier.", 360);
  single("sun_eccentricity_um", &ErrorInput::sun_eccentricity, "Eccentricity of the sun.", 1e4);
  single("sun_eccentricity_phase_deg", &ErrorInput::sun_eccentricity_phase, "Its direction at time 0.", 360);
  single("sun_installation_um", &ErrorInput::sun_installation, "Misplacement of the sun's axis.", 1e4);
  single("sun_installation_phase_deg", &ErrorInput::sun_installation_phase, "Its direction.", 360);
  single("ring_eccentricity_um", &ErrorInput::ring_eccentricity, "Eccentricity of the ring.", 1e4);
  single("ring_eccentricity_phase_deg", &ErrorInput::ring_eccentricity_phase, "Its direction.", 360);
  single("ring_installation_um", &ErrorInput::ring_installation, "Misplacement of the ring's axis.", 1e4);
  single("ring_installation_phase_deg", &ErrorInput::ring_installation_phase, "Its direction.", 360);
  single("carrier_eccentricity_um", &ErrorInput::carrier_eccentricity, "Eccentricity of the carrier.", 1e4);
  single("carrier_eccentricity_phase_deg", &ErrorInput::carrier_eccentricity_phase, "Its direction.", 360);
  single("carrier_installation_um", &ErrorInput::carrier_installation, "Misplacement of the carrier's axis.", 1e4);
  single("carrier_installation_phase_deg", &ErrorInput::carrier_installation_phase, "Its direction.", 360);
  single("sun_planet_misalignment_um", &ErrorInput::sun_planet_misalignment,
         "Misalignment of the sun mesh over the face width, normal to the flanks; positive opens it towards +z. The "
         "mesh becomes solid.",
         1000);
  single("ring_planet_misalignment_um", &ErrorInput::ring_planet_misalignment,
         "Misalignment of the ring mesh over the face width, normal to the flanks; positive opens it towards +z. The "
         "mesh becomes solid.",
         1000);
  const auto wave = [&](const char* name, double ErrorInput::*member, const char* meaning, double limit) {
    errors.key(name, member, meaning).fallback(0.0, "no error").from(-limit, limit).only(pair_alone);
  };
  errors
      .key("mesh_error_um", &ErrorInput::mesh_error,
           "Amplitude of the error at mesh frequency, along the normal of the flanks.")
      .from(-1e4, 1e4)
      .only(pair_alone)
      .absent("the reading of [manufacturing_error], or none");
  wave("mesh_error_phase_deg", &ErrorInput::mesh_error_phase, "Its phase: e sin(2π mesh frequency t + phase).", 360);
  wave("pinion_error_um", &ErrorInput::pinion_error,
       "Amplitude of the pinion's error once per turn, along the normal of the flanks.", 1e4);
  wave("pinion_error_phase_deg", &ErrorInput::pinion_error_phase, "Its phase.", 360);
  wave("wheel_error_um", &ErrorInput::wheel_error,
       "Amplitude of the wheel's error once per turn, along the normal of the flanks.", 1e4);
  wave("wheel_error_phase_deg", &ErrorInput::wheel_error_phase, "Its phase.", 360);
  wave("pinion_wheel_misalignment_um", &ErrorInput::pinion_wheel_misalignment,
       "Misalignment of a computed mesh over the face width, normal to the flanks; positive opens it towards +z.",
       1000);
  tables.push_back(errors.done());

  Declarations<SupportInput> supports(
      "supports",
      "Stiffness of the bearings; 0 is none (planets need one). Absent or inf means rigid, and the "
      "degree of freedom is dropped; so does a stiffness of a thousand meshes over the wanted accuracy.",
      [](Scene& s, std::size_t) -> SupportInput& { return s.supports; });
  supports.optional().only(planetary);
  const auto bearing = [&](const char* name, double SupportInput::*member, const char* meaning) {
    return supports.key(name, member, meaning).fallback(rigid, "rigid: the degree of freedom is dropped").infinite();
  };
  bearing("sun_N_per_m", &SupportInput::sun, "Support of the sun's axis, any direction.").from(0, 1e15);
  bearing("ring_N_per_m", &SupportInput::ring, "Support of the ring's axis, any direction.").from(0, 1e15);
  bearing("carrier_N_per_m", &SupportInput::carrier, "Support of the carrier's axis, any direction.").from(0, 1e15);
  bearing("planet_N_per_m", &SupportInput::planet, "Bearing of each planet on the carrier, radial and tangential.")
      .above(0, 1e15);
  bearing("ring_torsional_N_per_m", &SupportInput::ring_torsional,
          "Torsional support of the ring, in u = base radius × angle.")
      .from(0, 1e15);
  supports
      .key("sun_torsional_N_per_m", &SupportInput::sun_torsional,
           "Torsional support of the sun, in u = base radius × angle.")
      .fallback(0.0, "free: the sun carries the power")
      .from(0, 1e15);
  supports
      .key("carrier_torsional_N_per_m", &SupportInput::carrier_torsional,
           "Torsional support of the carrier, in u = centre distance × angle.")
      .fallback(0.0, "free: the carrier carries the power")
      .from(0, 1e15);
  tables.push_back(supports.done());

  tables.push_back(mesh_table("mesh.sun_planet", "Stiffness of the sun mesh, given instead of computed.", with_planets,
                              [](Scene& s, std::size_t) -> MeshInput& { return s.sun_planet; }));
  tables.push_back(mesh_table("mesh.ring_planet", "Stiffness of the ring mesh, given instead of computed.", planetary,
                              [](Scene& s, std::size_t) -> MeshInput& { return s.ring_planet; }));
  tables.push_back(mesh_table(
      "mesh.arc_pins", "Stiffness of the arc teeth on their pins, given instead of computed by the contact formulas.",
      {StageKind::two_k_v}, [](Scene& s, std::size_t) -> MeshInput& { return s.arc_pins; }));

  declare_pair(tables);

  Declarations<DynamicsInput> lumped("dynamics", "The lumped model; absent: meshes and stiffness only.",
                                     [](Scene& s, std::size_t) -> DynamicsInput& {
                                       if (!s.dynamics) s.dynamics.emplace();
                                       return *s.dynamics;
                                     });
  lumped.optional();
  lumped
      .key("half_backlash_um", &DynamicsInput::half_backlash, "Half the backlash along the line of action, every mesh.")
      .required()
      .from(0, 1e4);
  lumped.key("mesh_damping_ratio", &DynamicsInput::mesh_damping_ratio, "Damping ratio ζ of every mesh: c = 2ζ√(k m_e).")
      .required()
      .from(0, 2);
  lumped.key("support_damping_ratio", &DynamicsInput::support_damping_ratio, "Damping ratio of every bearing.")
      .required()
      .from(0, 2);
  lumped
      .choice("mesh_damping", &DynamicsInput::mesh_damping,
              {{"in_contact", MeshDamping::in_contact}, {"always", MeshDamping::always}},
              "When mesh damping acts. `always` is the literal form of the papers; it lets separated flanks pull.")
      .fallback(std::string("in_contact"), "separated flanks exert no force");
  lumped
      .choice("load_dependence", &DynamicsInput::load_dependence,
              {{"table", dynamics::LoadDependence::table}, {"nominal", dynamics::LoadDependence::nominal}},
              "Force of a mesh with a stiffness table. table: the law of force over deflection through all tabulated "
              "loads; nominal: linear, with the secant stiffness at the mean mesh force.")
      .fallback(std::string("table"), "right at whatever load the mesh carries at the moment");
  lumped
      .choice("rim_coupling", &DynamicsInput::rim_coupling,
              {{"automatic", RimCoupling::automatic},
               {"none", RimCoupling::none},
               {"static", RimCoupling::statical},
               {"elastic", RimCoupling::elastic}},
              "How the meshes of one ring act on each other through it. none: not at all; static: by its compliance at "
              "every ring position; elastic: with the inertia of its elastic modes besides, by time integration; "
              "automatic: static where the coupling exceeds the wanted accuracy, else none.")
      .only(planetary)
      .fallback(std::string("automatic"), "only what changes the answer is modelled");
  lumped
      .choice("integrator", &DynamicsInput::integrator,
              {{"automatic", dynamics::Integrator::automatic},
               {"explicit", dynamics::Integrator::arkode_explicit},
               {"adams", dynamics::Integrator::cvode_adams},
               {"bdf", dynamics::Integrator::cvode_bdf},
               {"implicit", dynamics::Integrator::arkode_implicit},
               {"runge_kutta_4", dynamics::Integrator::runge_kutta_4}},
              "Time integration. explicit: Runge-Kutta of order 5 with adaptive steps (ARKODE); adams, bdf: CVODE; "
              "implicit: L-stable Runge-Kutta of order 5 (ARKODE), for speeds so low that vibrations die within a mesh "
              "cycle; "
              "runge_kutta_4: the classical method with fixed steps, as in the papers; automatic: explicit, bdf or "
              "implicit by stiffness ratio and damping.")
      .fallback(std::string("automatic"), "the faster one of those that are accurate");
  lumped.key("steps_per_cycle", &DynamicsInput::steps_per_cycle, "runge_kutta_4: steps per mesh cycle.")
      .from(10, 1e6)
      .absent("needed by runge_kutta_4, and only there");
  lumped.key("mesh_cycles", &DynamicsInput::mesh_cycles, "Mesh cycles to integrate.")
      .from(1, 1e6)
      .absent("until the periodic steady state is reached, then one error period");
  lumped.key("relative_tolerance", &DynamicsInput::relative_tolerance, "Relative tolerance of the time integration.")
      .from(1e-12, 1e-2)
      .absent("planetary stages: a ten-thousandth of the wanted accuracy, 1e-8 to 1e-5; else 1e-6");
  tables.push_back(lumped.done());
  declare_studies(tables);
  return tables;
}

}  // namespace

const std::vector<Table>& schema() {
  static const std::vector<Table> tables = declare_tables();
  return tables;
}

const std::vector<std::pair<std::string, std::string>>& unavailable_tables() {
  static const std::vector<std::pair<std::string, std::string>> tables = {
      {"modes", "choice of vibration modes"},
  };
  return tables;
}

}  // namespace annulus::app
