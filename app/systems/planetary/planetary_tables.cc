#include "app/scene/gear_tables.h"
#include "app/systems/planetary/planetary_scene.h"

namespace annulus::app {

namespace {

/// A turn in two years; powers divided by less are no torques.
constexpr double slowest_rpm = 1e-6;

Condition sun_mesh_computed() { return is("mesh.sun_planet.stiffness", {"computed"}); }
Condition ring_mesh_computed() { return is("mesh.ring_planet.stiffness", {"computed"}); }

Table planetary_stage_table() {
  Declarations<StageInput> stage("stage", "", [](Scene& s, std::size_t) -> StageInput& { return s.stage; });
  declare_planets(stage);
  stage
      .key("planet_angles_deg", &StageInput::planet_angles,
           "Angular positions of the planets, one per planet, counter-clockwise from the first, which stands at 0; two "
           "decimals are enough. A planet fits between the teeth of sun and ring every 360° / (teeth of the sun + "
           "teeth of the ring).")
      .from(0, 360)
      .absent("equally spaced");
  declare_centre_distance(stage).required();
  stage.key("power_kW", &StageInput::power, "Transmitted power; the sun drives, the carrier is driven.")
      .above(0, 1e6)
      .required();
  stage.key("sun_speed_rpm", &StageInput::sun_speed, "Speed of the sun.")
      .from(slowest_rpm, 1e6)
      .absent("follows from carrier_speed_rpm");
  stage.key("carrier_speed_rpm", &StageInput::carrier_speed, "Speed of the carrier.")
      .from(slowest_rpm, 1e6)
      .instead_of({"sun_speed_rpm"})
      .absent("follows from sun_speed_rpm");
  return stage.done();
}

Table planetary_hub_gear_table(const char* path, const char* meaning, HubGearInput& (*section)(Scene&, std::size_t),
                               const Condition& computed) {
  Declarations<HubGearInput> gear(path, meaning, section);
  declare_teeth(gear, Flanks::external);
  declare_mass(gear);
  declare_inertia(gear).required_if(given("[dynamics]"));
  declare_flanks(gear, Flanks::external);
  declare_bore(gear, computed);
  return gear.done();
}

Table carrier_table() {
  Declarations<CarrierInput> carrier("carrier", "The planet carrier.",
                                     [](Scene& s, std::size_t) -> CarrierInput& { return s.carrier; });
  carrier.optional();
  declare_mass(carrier, "Mass without planets.");
  declare_inertia(carrier, "Moment of inertia about the axis, without planets.").required_if(given("[dynamics]"));
  return carrier.done();
}

void declare_planet_errors(Declarations<ErrorInput>& errors) {
  const auto list = [&](const char* name, std::vector<double> ErrorInput::*member, const char* meaning, double limit) {
    return errors.key(name, member, meaning).fallback(std::vector<double>{}, "0 for every planet").from(-limit, limit);
  };
  list("planet_eccentricity_um", &ErrorInput::planet_eccentricity, "Eccentricity of each planet.", 1e4);
  list("planet_eccentricity_phase_deg", &ErrorInput::planet_eccentricity_phase,
       "Direction of the eccentricity at time 0, in the planet's own frame.", 360);
  list("planet_pin_position_error_um", &ErrorInput::planet_installation, "Position error of each planet pin.", 1e4)
      .formerly("planet_installation_um");
  list("planet_pin_position_error_phase_deg", &ErrorInput::planet_installation_phase,
       "Direction of the pin position error, in the frame of the carrier.", 360)
      .formerly("planet_installation_phase_deg");
}

Table planetary_errors_table() {
  Declarations<ErrorInput> errors(
      "errors", "Manufacturing errors. Lists have one value per planet. Eccentricities turn with their body.",
      [](Scene& s, std::size_t) -> ErrorInput& { return s.errors; });
  errors.optional();
  declare_planet_errors(errors);
  const auto single = [&](const char* name, double ErrorInput::*member, const char* meaning, double limit) {
    return errors.key(name, member, meaning).fallback(0.0, "no error").from(-limit, limit);
  };
  single("sun_eccentricity_um", &ErrorInput::sun_eccentricity, "Eccentricity of the sun.", 1e4);
  single("sun_eccentricity_phase_deg", &ErrorInput::sun_eccentricity_phase, "Its direction at time 0.", 360);
  single("sun_position_error_um", &ErrorInput::sun_installation, "Position error of the sun's axis.", 1e4)
      .formerly("sun_installation_um");
  single("sun_position_error_phase_deg", &ErrorInput::sun_installation_phase, "Its direction.", 360)
      .formerly("sun_installation_phase_deg");
  single("ring_eccentricity_um", &ErrorInput::ring_eccentricity, "Eccentricity of the ring.", 1e4);
  single("ring_eccentricity_phase_deg", &ErrorInput::ring_eccentricity_phase, "Its direction.", 360);
  single("ring_position_error_um", &ErrorInput::ring_installation, "Position error of the ring's axis.", 1e4)
      .formerly("ring_installation_um");
  single("ring_position_error_phase_deg", &ErrorInput::ring_installation_phase, "Its direction.", 360)
      .formerly("ring_installation_phase_deg");
  single("carrier_eccentricity_um", &ErrorInput::carrier_eccentricity, "Eccentricity of the carrier.", 1e4);
  single("carrier_eccentricity_phase_deg", &ErrorInput::carrier_eccentricity_phase, "Its direction.", 360);
  single("carrier_position_error_um", &ErrorInput::carrier_installation, "Position error of the carrier's axis.", 1e4)
      .formerly("carrier_installation_um");
  single("carrier_position_error_phase_deg", &ErrorInput::carrier_installation_phase, "Its direction.", 360)
      .formerly("carrier_installation_phase_deg");
  single("sun_planet_misalignment_um", &ErrorInput::sun_planet_misalignment,
         "Misalignment of the sun mesh over the face width, normal to the flanks; positive opens it towards +z. The "
         "mesh becomes solid.",
         1000);
  single("ring_planet_misalignment_um", &ErrorInput::ring_planet_misalignment,
         "Misalignment of the ring mesh over the face width, normal to the flanks; positive opens it towards +z. The "
         "mesh becomes solid.",
         1000);
  return errors.done();
}

Table supports_table() {
  Declarations<SupportInput> supports(
      "supports",
      "Stiffness of the bearings; 0 is none (planets need one). Absent or inf means rigid, and the degree of freedom "
      "is dropped; so does a stiffness of a thousand meshes over the wanted accuracy.",
      [](Scene& s, std::size_t) -> SupportInput& { return s.supports; });
  supports.optional();
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
  return supports.done();
}

Table rim_coupling_key() {
  Declarations<DynamicsInput> lumped("dynamics", "", [](Scene& s, std::size_t) -> DynamicsInput& {
    if (!s.dynamics) s.dynamics.emplace();
    return *s.dynamics;
  });
  lumped
      .choice("rim_coupling", &DynamicsInput::rim_coupling,
              {{"automatic", RimCoupling::automatic},
               {"none", RimCoupling::none},
               {"static", RimCoupling::statical},
               {"elastic", RimCoupling::elastic}},
              "How the meshes of one ring act on each other through it. none: not at all; static: by its compliance at "
              "every ring position; elastic: with the inertia of its elastic modes besides, by time integration; "
              "automatic: static where the coupling exceeds the wanted accuracy, else none.")
      .fallback(std::string("automatic"), "only what changes the answer is modelled");
  return lumped.done();
}

Table optimised_ring_key() {
  Declarations<OptimiseInput> optimise("optimise", "", [](Scene& s, std::size_t) -> OptimiseInput& {
    if (!s.optimise) s.optimise.emplace();
    return *s.optimise;
  });
  optimise.key("ring", &OptimiseInput::ring, "The ring whose results count.").absent("the first");
  return optimise.done();
}

}  // namespace

std::vector<Table> planetary_tables() {
  return {
      planetary_stage_table(),
      planetary_hub_gear_table(
          "sun", "The sun gear.", [](Scene& s, std::size_t) -> HubGearInput& { return s.sun; }, sun_mesh_computed()),
      planetary_hub_gear_table(
          "planet", "Each planet gear.", [](Scene& s, std::size_t) -> HubGearInput& { return s.planet; },
          sun_mesh_computed() || ring_mesh_computed()),
      carrier_table(),
      ring_table(),
      planetary_errors_table(),
      supports_table(),
      declare_mesh("mesh.sun_planet", "Stiffness of the sun mesh, prescribed instead of computed.",
                   [](Scene& s, std::size_t) -> MeshInput& { return s.sun_planet; })
          .done(),
      declare_mesh("mesh.ring_planet", "Stiffness of the ring mesh, prescribed instead of computed.",
                   [](Scene& s, std::size_t) -> MeshInput& { return s.ring_planet; })
          .done(),
      rim_coupling_key(),
      optimised_ring_key()};
}

}  // namespace annulus::app
