#include <fmt/format.h>

#include <tuple>

#include "app/scene/gear_tables.h"
#include "app/systems/planetary/pitch_deviations.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_scene.h"
#include "app/systems/planetary/strain_gauges.h"
#include "app/systems/planetary/structure_tables.h"
#include "app/systems/shared/friction.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/shared/sun_planet_input.h"
#include "geometry/flank_tolerances.h"

namespace annulus::app {

namespace {

using geometry::StageMember;

/// Which member is held, which one drives, how fast and how hard.
Table power_flow_keys() {
  Declarations stage("stage", "", &PlanetaryInput::stage);
  const std::vector<Choice<StageMember>> members = {
      {"sun", StageMember::sun}, {"carrier", StageMember::carrier}, {"ring", StageMember::ring}};
  std::vector<Choice<std::optional<StageMember>>> held = {{"none", std::nullopt}};
  for (const auto& member : members) held.push_back({member.name, member.value});
  stage
      .choice("held", &PlanetaryStageInput::held, held,
              "The member that does not turn. none: a differential, whose speeds are two keys. All three members then "
              "turn.")
      .fallback("ring", "the usual case");
  stage
      .choice("drives", &PlanetaryStageInput::drives, members,
              "The member whose torque acts in its direction of rotation. Where a load drives back, as in braking, it "
              "is the member on the side of the load.")
      .fallback("sun", "a reducer");
  stage.key("power_kW", &PlanetaryStageInput::power, "Power of the member that drives.")
      .above(0, 1e6)
      .one_of({"sun_torque_Nm", "carrier_torque_Nm", "ring_torque_Nm"})
      .absent("follows from the torque and the speed");
  constexpr double largest_torque = 1e9;
  const char* from_power = "follows from the power and the speed";
  stage
      .key("sun_torque_Nm", &PlanetaryStageInput::sun_torque,
           "Torque of the sun, instead of the power. It stays the same where a sweep changes the speed.")
      .above(0, largest_torque)
      .absent(from_power);
  stage.key("carrier_torque_Nm", &PlanetaryStageInput::carrier_torque, "Torque of the carrier, instead of the power.")
      .above(0, largest_torque)
      .absent(from_power);
  stage.key("ring_torque_Nm", &PlanetaryStageInput::ring_torque, "Torque of the ring, instead of the power.")
      .above(0, largest_torque)
      .absent(from_power);
  const auto speed = [&](const char* name, std::optional<double> PlanetaryStageInput::*member, const char* meaning,
                         const char* held_member, const char* why) {
    return stage.key(name, member, meaning)
        .from(-1e6, 1e6)
        .refused_if(is("held", {held_member}), why)
        .absent("follows from the other speeds");
  };
  speed("sun_speed_rpm", &PlanetaryStageInput::sun_speed,
        "Speed of the sun; negative: clockwise. One speed is given, or two of a differential.", "sun",
        "the sun is held")
      .some_of({"carrier_speed_rpm", "ring_speed_rpm"});
  speed("carrier_speed_rpm", &PlanetaryStageInput::carrier_speed, "Speed of the carrier; negative: clockwise.",
        "carrier", "the carrier is held");
  speed("ring_speed_rpm", &PlanetaryStageInput::ring_speed, "Speed of the ring; negative: clockwise.", "ring",
        "the ring is held");
  return stage.done();
}

Table planet_angles_key() {
  Declarations stage("stage", "", &PlanetaryInput::stage);
  stage
      .key("planet_angles_deg", &PlanetaryStageInput::planet_angles,
           "Angular positions of the planets, counter-clockwise from the first planet at 0. Two decimals are enough. A "
           "planet fits between the teeth of sun and ring every 360° / (teeth of the sun + teeth of the ring).")
      .from(0, 360)
      .absent("equally spaced");
  return stage.done();
}

Table planetary_stage_table() {
  Declarations stage("stage", "", &Scene::stage);
  declare_planets(stage);
  stage.add(planet_angles_key());
  declare_centre_distance(stage).required();
  declare_tip_shortening(stage);
  stage.add(power_flow_keys());
  return stage.done();
}

constexpr const char* needs_weight = "all bodies have a weight";

Table planetary_hub_gear_table(const char* path, const char* meaning, HubGearInput SunPlanetInput::*member,
                               const char* mate, const Condition& computed) {
  Declarations gear(path, meaning, member);
  declare_teeth(gear, Flanks::external, mate);
  declare_mass(gear).required_if(given("[gravity]"), needs_weight);
  declare_inertia(gear).required_if(given("[dynamics]"));
  declare_own_face(gear);
  declare_own_material(gear);
  declare_flanks(gear, Flanks::external);
  declare_bore(gear, computed);
  return gear.done();
}

Table planet_bore_key(const Condition& computed) {
  Declarations planet("planet", "", &SunPlanetInput::planet);
  planet
      .choice(
          "bore", &HubGearInput::bore, {{"hub", BoreOn::hub}, {"rollers", BoreOn::rollers}},
          "What the bore stands on. hub: a rigid hub, to which the body is fixed. rollers: the bore is the raceway of "
          "the planet's bearing, whose stiffness and clearance are those of [supports]. Both meshes then bend the "
          "rim of the planet.")
      .only_if(computed, "a prescribed stiffness does not describe the body")
      .only_if(given("supports.planet_N_per_m"), "the bearing of a planet on rollers needs a stiffness")
      .refused_if(given("supports.planet_radial_N_per_m"), "the bearing has one stiffness in all directions")
      .refused_if(given("supports.planet_tangential_N_per_m"), "the bearing has one stiffness in all directions")
      .fallback("hub", "a rim so thick that it stays round");
  return planet.done();
}

Table carrier_table() {
  Declarations carrier("carrier", "The planet carrier.", &PlanetaryInput::carrier);
  carrier.optional();
  declare_mass(carrier, "Mass without planets.").required_if(given("[gravity]"), needs_weight);
  declare_inertia(carrier, "Moment of inertia about the axis, without planets.").required_if(given("[dynamics]"));
  return carrier.done();
}

/// Amplitude and direction of one error of a body, as lists for the planets.
template <class Section, class T>
void declare_error(Declarations<Section>& errors, const std::string& name, T Section::*amplitude, T Section::*phase,
                   const std::string& meaning, const char* direction, const std::string& old_name = "") {
  const bool planets = !std::is_same_v<T, double>;
  for (const auto& [ending, member, text, limit] :
       {std::tuple{"_um", amplitude, meaning.c_str(), 1e4}, {"_phase_deg", phase, direction, 360.0}}) {
    auto key = errors.key(name + ending, member, text);
    key.fallback(T{}, planets ? "0 for every planet" : "no error").from(-limit, limit);
    if (!old_name.empty()) key.formerly(old_name + ending);
  }
}

Table body_errors(const std::string& body, BodyErrorInput PlanetaryErrorInput::*member) {
  Declarations<BodyErrorInput> errors(
      "errors", "", [member](Scene& s, std::size_t) -> BodyErrorInput& { return planetary(s).errors.*member; });
  declare_error(errors, body + "_eccentricity", &BodyErrorInput::eccentricity, &BodyErrorInput::eccentricity_phase,
                "Eccentricity of the " + body + ".", "Its direction at time 0.");
  declare_error(errors, body + "_position_error", &BodyErrorInput::position, &BodyErrorInput::position_phase,
                "Position error of the " + body + "'s axis.", "Its direction.", body + "_installation");
  return errors.done();
}

Table planetary_errors_table() {
  Declarations errors("errors",
                      "Manufacturing errors. Lists have one value per planet. Eccentricities turn with their body.",
                      &PlanetaryInput::errors);
  errors.optional();
  declare_error(errors, "planet_eccentricity", &PlanetaryErrorInput::planet_eccentricity,
                &PlanetaryErrorInput::planet_eccentricity_phase, "Eccentricity of each planet.",
                "Direction of the eccentricity at time 0, in the planet's own frame.");
  declare_error(errors, "planet_pin_position_error", &PlanetaryErrorInput::planet_pin_position,
                &PlanetaryErrorInput::planet_pin_position_phase, "Position error of each planet pin.",
                "Direction of the pin position error, in the frame of the carrier.", "planet_installation");
  errors.add(body_errors("sun", &PlanetaryErrorInput::sun))
      .add(body_errors("ring", &PlanetaryErrorInput::ring))
      .add(body_errors("carrier", &PlanetaryErrorInput::carrier));
  errors.add(pitch_deviation_keys());
  for (const auto& [mesh, member] : {std::pair{"sun", &PlanetaryErrorInput::sun_planet_misalignment},
                                     {"ring", &PlanetaryErrorInput::ring_planet_misalignment}})
    errors
        .key(std::string(mesh) + "_planet_misalignment_um", member,
             std::string("Misalignment of the ") + mesh +
                 " mesh over the face width, normal to the flanks; positive opens it towards +z. The mesh then needs "
                 "the solid model.")
        .fallback(0.0, "no error")
        .from(-1000, 1000);
  return errors.done();
}

Table supports_table() {
  Declarations supports("supports",
                        "Stiffness of the bearings; 0 means no bearing (planets need one). If it is absent or inf, the "
                        "bearing is rigid and the degree of freedom is dropped. A stiffness above a thousand mesh "
                        "stiffnesses over the wanted accuracy also counts as rigid.",
                        &PlanetaryInput::supports);
  supports.optional();
  const auto support = [&](const char* name, double SupportInput::*member, double value, const char* why,
                           const char* meaning) {
    return supports.key(name, member, meaning).fallback(value, why).from(0, 1e15).often_assumed();
  };
  const auto bearing = [&](const char* name, double SupportInput::*member, const char* meaning) {
    return support(name, member, rigid, "rigid: the degree of freedom is dropped", meaning)
        .infinite()
        .word("rigid", rigid);
  };
  supports.key("sun_N_per_m", &SupportInput::sun, "Support of the sun's axis in any direction; floating: no support.")
      .from(0, 1e15)
      .infinite()
      .word("rigid", rigid)
      .word("floating", 0)
      .often_assumed()
      .absent("no lumped model, a single planet, or a [[bearing]] that holds the sun: rigid")
      .required_if(given("[dynamics]") && !is("stage.planets", {"1"}) && !given("[bearing]"),
                   "it has the largest effect on load sharing; a rigid sun does not equalise the planet loads");
  bearing("ring_N_per_m", &SupportInput::ring, "Support of the ring's axis in any direction.");
  bearing("carrier_N_per_m", &SupportInput::carrier, "Support of the carrier's axis in any direction.");
  bearing("planet_N_per_m", &SupportInput::planet, "Bearing of each planet on the carrier, radial and tangential.")
      .above(0, 1e15);
  for (const auto& [direction, member] :
       {std::pair{"radial", &SupportInput::planet_radial}, {"tangential", &SupportInput::planet_tangential}})
    supports
        .key(fmt::format("planet_{}_N_per_m", direction), member,
             fmt::format("{} stiffness of each planet's bearing, one value per planet; inf: rigid.",
                         direction == std::string("radial") ? "Radial" : "Tangential"))
        .above(0, 1e15)
        .infinite()
        .often_assumed()
        .absent("planet_N_per_m");
  supports
      .key("planet_clearance_um", &SupportInput::planet_clearance,
           "Radial clearance of each planet's bearing (ISO 5753-1): how far the planet moves across it from stop to "
           "stop. Rollers then carry over a part of the bearing that grows with the load; planet_N_per_m is the "
           "stiffness without clearance.")
      .only_if(given("planet_N_per_m"), "the bearing needs a stiffness")
      .refused_if(given("planet_radial_N_per_m"), "the bearing has one stiffness in all directions")
      .refused_if(given("planet_tangential_N_per_m"), "the bearing has one stiffness in all directions")
      .fallback(0.0, "rollers carry on both sides of the bearing")
      .from(0, 1000)
      .often_assumed();
  supports
      .choice(
          "planet_pin", &SupportInput::planet_pin,
          {{"rigid", PinMounting::unbending},
           {"between_walls", PinMounting::between_walls},
           {"cantilever", PinMounting::cantilever},
           {"flexpin", PinMounting::flexpin}},
          "What carries a planet's bearing; its compliance is added to that of the bearing. rigid: nothing is "
          "added. between_walls: a pin clamped in both walls of the carrier, loaded in the middle. cantilever: a pin "
          "clamped in one wall. flexpin: a pin clamped in one wall, whose other end carries a sleeve; the middle "
          "of the planet lies over the middle of the pin, which keeps it parallel.")
      .fallback("rigid", "planet_N_per_m contains the pin");
  const auto bends = !is("planet_pin", {"rigid"});
  supports.key("planet_pin_diameter_mm", &SupportInput::pin_diameter, "Diameter of a solid pin where it bends.")
      .above(0, 1000)
      .needed_if(bends, "the stiffness of the pin follows from it");
  supports
      .key("planet_pin_length_mm", &SupportInput::pin_length,
           "Length of pin that bends. between_walls: from wall to wall; cantilever: from the wall to the middle of the "
           "planet; flexpin: from the wall to the sleeve.")
      .above(0, 1000)
      .needed_if(bends, "the stiffness of the pin follows from it");
  const auto torsional = [&](const char* name, std::optional<double> SupportInput::*member, const char* meaning,
                             const char* absent = "rigid where this member is held, otherwise none: it turns") {
    supports.key(name, member, meaning).from(0, 1e15).infinite().word("rigid", rigid).often_assumed().absent(absent);
  };
  torsional("ring_torsional_N_per_m", &SupportInput::ring_torsional,
            "Torsional support of the ring, in u = base radius × angle.",
            "rigid where the ring is held and not in mounts beside its axis, otherwise none: it turns");
  torsional("sun_torsional_N_per_m", &SupportInput::sun_torsional,
            "Torsional support of the sun, in u = base radius × angle.");
  torsional("carrier_torsional_N_per_m", &SupportInput::carrier_torsional,
            "Torsional support of the carrier, in u = centre distance × angle.");
  for (const auto& [name, member, what] : {std::tuple{"sun_damping_ratio", &SupportInput::sun_damping, "sun"},
                                           {"ring_damping_ratio", &SupportInput::ring_damping, "ring"},
                                           {"carrier_damping_ratio", &SupportInput::carrier_damping, "carrier"},
                                           {"planet_damping_ratio", &SupportInput::planet_damping, "planets"}})
    supports.key(name, member, fmt::format("Damping ratio of bearings and supports of the {}.", what))
        .from(0, 2)
        .absent("dynamics.support_damping_ratio");
  return supports.done();
}

Table tolerances_table() {
  Declarations tolerances(
      "tolerances",
      "Load sharing of many assemblies that are made within these tolerances: K_γ below which 50, 95 and 99 % of them "
      "stay, at several torques, and what each tolerance contributes. Drawn deviations replace those of [errors] of "
      "the "
      "same kind.",
      &PlanetaryInput::tolerances);
  tolerances.study();
  tolerances
      .key("accuracy_class", &ToleranceInput::accuracy_class,
           "Flank tolerance class of ISO 1328-1 of sun, planets and ring. Their eccentricities reach up to half the "
           "runout tolerance of the class.")
      .from(geometry::best_flank_class, geometry::worst_flank_class)
      .absent("no eccentricities but those of the runout keys and of gears with a class of their own");
  for (const auto& [name, member] : {std::pair{"sun", &ToleranceInput::sun_class},
                                     {"planet", &ToleranceInput::planet_class},
                                     {"ring", &ToleranceInput::ring_class}})
    tolerances
        .key(std::string(name) + "_accuracy_class", member,
             std::string("Flank tolerance class of the ") + name + ", where it is not that of the others.")
        .from(geometry::best_flank_class, geometry::worst_flank_class)
        .absent("accuracy_class");
  for (const auto& [name, member] : {std::pair{"sun", &ToleranceInput::sun_runout},
                                     {"planet", &ToleranceInput::planet_runout},
                                     {"ring", &ToleranceInput::ring_runout}})
    tolerances
        .key(std::string(name) + "_runout_um", member,
             std::string("Runout tolerance of the ") + name + " on its bearing; the eccentricity reaches half of it.")
        .from(0, 1e4)
        .absent("the runout tolerance of the accuracy class, or no eccentricity");
  tolerances
      .key("planet_pin_position_um", &ToleranceInput::planet_pin_position,
           "Position tolerance of the planet pins: the diameter of the zone in which each axis lies (ISO 1101).")
      .from(0, 1e4)
      .absent("no pin position errors");
  tolerances
      .choice(
          "distribution", &ToleranceInput::distribution,
          {{"normal", ToleranceLaw::normal}, {"uniform", ToleranceLaw::uniform}},
          "Where a deviation lies in its circular zone. normal: both coordinates normal, their standard deviation a "
          "third of the radius, cut at the zone; uniform: anywhere in the zone with equal probability. All "
          "directions are equally probable.")
      .fallback("normal", "a process that just holds its tolerances");
  tolerances.key("assemblies", &ToleranceInput::assemblies, "Number of assemblies drawn.")
      .fallback(1000, "the 99 % quantile with an interval")
      .from(100, 100000);
  tolerances.key("seed", &ToleranceInput::seed, "Other seeds give other draws.")
      .fallback(1, "any number will do")
      .from(0, 2147483647);
  tolerances
      .key("torque_shares", &ToleranceInput::torque_shares,
           "Torques at which the load sharing is computed, as shares of the torque of [stage]; 1 is always added.")
      .fallback(std::vector<double>{0.25, 0.5, 0.75, 1, 1.25}, "from light load to overload")
      .above(0, 10)
      .longest(20)
      .not_empty("share")
      .distinct();
  return tolerances.done();
}

Table rim_coupling_key() {
  Declarations<PlanetaryInput> lumped("dynamics", "");
  lumped
      .choice("rim_coupling", &PlanetaryInput::rim_coupling,
              {{"automatic", RimCoupling::automatic},
               {"none", RimCoupling::none},
               {"static", RimCoupling::statical},
               {"elastic", RimCoupling::elastic}},
              "Coupling of the meshes of one ring through the ring. none: no coupling. static: by the compliance of "
              "the ring at every position. elastic: also with the inertia of its elastic modes, by time integration. "
              "automatic: static if the coupling exceeds a tenth of the wanted accuracy, else none.")
      .fallback("automatic", "only a coupling that changes the results is modelled");
  return lumped.done();
}

Table optimised_ring_key() {
  Declarations optimise("optimise", "", &Scene::optimise);
  optimise.key("ring", &OptimiseInput::variant, "The ring whose results are optimised.").absent("the first");
  return optimise.done();
}

}  // namespace

std::vector<Table> planetary_tables() {
  const auto sun_computed = is("mesh.sun_planet.stiffness", {"computed"}),
             ring_computed = is("mesh.ring_planet.stiffness", {"computed"});
  const auto mesh = [](const char* path, const char* meaning, auto member) {
    return declare_mesh({path, meaning, member}).done();
  };
  std::vector<Table> tables = {
      planetary_stage_table(),
      planetary_hub_gear_table("sun", "The sun gear.", &SunPlanetInput::sun, "planet", sun_computed),
      planetary_hub_gear_table("planet", "Each planet gear.", &SunPlanetInput::planet, "sun",
                               sun_computed || ring_computed),
      planet_bore_key(sun_computed || ring_computed),
      carrier_table(),
      ring_table(),
      planetary_errors_table(),
      supports_table(),
      mesh("mesh.sun_planet", "Stiffness of the sun mesh, prescribed instead of computed.",
           &SunPlanetInput::sun_planet),
      mesh("mesh.ring_planet", "Stiffness of the ring mesh, prescribed instead of computed.",
           &PlanetaryInput::ring_planet),
      rim_coupling_key(),
      rotor_table(),
      tolerances_table(),
      strain_gauge_table(),
      optimised_ring_key()};
  for (auto more : {friction_tables(), structure_tables()})
    std::move(more.begin(), more.end(), std::back_inserter(tables));
  return tables;
}

}  // namespace annulus::app
