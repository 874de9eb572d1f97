#include <iterator>
#include <utility>

#include "app/scene/gear_tables.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/pair_scene.h"
#include "app/systems/shared/friction.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/shared/space_tables.h"

namespace annulus::app {

namespace {

using Body = dynamics::StageBody::Kind;

Table pair_stage_table() {
  Declarations stage("stage", "", &Scene::stage);
  declare_centre_distance(stage)
      .absent("the distance without backlash, from the profile shifts")
      .required_if(is("tip_shortening", {"full"}));
  declare_tip_shortening(stage);
  Declarations own("stage", "", &PairInput::stage);
  own.key("pinion_torque_Nm", &PairStageInput::pinion_torque,
          "Torque that drives the pinion. Negative: the back flanks carry it.")
      .from(-1e9, 1e9)
      .required();
  own.key("pinion_speed_rpm", &PairStageInput::pinion_speed, "Speed of the pinion.").above(0, 1e6).required();
  stage.add(own.done());
  return stage.done();
}

Table pair_gear_table(const char* path, const char* meaning, PairGearInput PairInput::*member) {
  Declarations gear(path, meaning, member);
  declare_teeth(gear, Flanks::external, "other gear");
  declare_mass(gear);
  declare_inertia(gear).absent("½ m r² of a solid disc, r: reference circle");
  declare_own_face(gear);
  declare_own_material(gear);
  declare_flanks(gear, Flanks::external);
  declare_bore(gear, is("mesh.pinion_wheel.stiffness", {"computed", "closed_form"}));
  const auto bearing = [&](const char* name, double PairGearInput::*stiffness, const char* what) {
    gear.key(name, stiffness, what)
        .fallback(rigid, "rigid: the degree of freedom is dropped")
        .above(0, 1e15)
        .infinite()
        .often_assumed();
  };
  bearing("bearing_transverse_N_per_m", &PairGearInput::bearing_transverse,
          "Bearings and shaft along the transverse line of action.");
  bearing("bearing_axial_N_per_m", &PairGearInput::bearing_axial, "Axial bearing.");
  gear.key("bearing_damping_ratio", &PairGearInput::damping_ratio, "Damping ratio of its bearings.")
      .often_assumed()
      .from(0, 2)
      .absent("dynamics.support_damping_ratio");
  return gear.done();
}

Table pair_errors_table() {
  Declarations errors("errors", "Manufacturing errors.", &PairInput::errors);
  errors.optional();
  const auto wave = [&](const char* name, double PairErrorInput::*member, const char* meaning, double limit) {
    return errors.key(name, member, meaning).fallback(0.0, "no error").from(-limit, limit);
  };
  errors
      .key("mesh_error_um", &PairErrorInput::mesh_error,
           "Amplitude of the error at mesh frequency, along the normal of the flanks.")
      .from(-1e4, 1e4)
      .refused_if(given("[manufacturing_error]") && !is("manufacturing_error.reading", {"none"}),
                  "the error at mesh frequency follows from that table; leave one out, or set "
                  "manufacturing_error.reading = \"none\"")
      .absent("the reading of [manufacturing_error], or none");
  wave("mesh_error_phase_deg", &PairErrorInput::mesh_error_phase, "Its phase: e sin(2π mesh frequency t + phase).",
       360);
  wave("pinion_error_um", &PairErrorInput::pinion_error,
       "Amplitude of the pinion's error once per turn, along the normal of the flanks.", 1e4);
  wave("pinion_error_phase_deg", &PairErrorInput::pinion_error_phase, "Its phase.", 360);
  wave("wheel_error_um", &PairErrorInput::wheel_error,
       "Amplitude of the wheel's error once per turn, along the normal of the flanks.", 1e4);
  wave("wheel_error_phase_deg", &PairErrorInput::wheel_error_phase, "Its phase.", 360);
  wave("pinion_wheel_misalignment_um", &PairErrorInput::pinion_wheel_misalignment,
       "Misalignment of a computed mesh over the face width, normal to the flanks; positive opens it towards +z.", 1000)
      .only_if(is("mesh.pinion_wheel.stiffness", {"computed"}),
               "other stiffnesses do not depend on positions along the face width");
  return errors.done();
}

Table pair_mesh_table() {
  auto mesh = declare_mesh(
      {"mesh.pinion_wheel",
       "Stiffness of the mesh along the normal of the flanks. computed: finite elements (`model`); iso_6336: mean "
       "after ISO 6336-1 method B, with `ripple` if one is given; closed_form: tooth formulas of the transverse "
       "section, staggered along the helix. Forces and errors of a table are those of the transverse section.",
       &PairInput::pinion_wheel},
      {.more_shapes = {{"iso_6336", StiffnessShape::iso_6336}, {"closed_form", StiffnessShape::closed_form}},
       .more_waves = {"iso_6336"},
       .constant_shape = "iso_6336: constant"});
  mesh.key("single_stiffness_GPa", &MeshInput::single_stiffness,
           "Stiffness c′ of one pair of spur teeth per unit of face width; 1 GPa = 1 N/(mm µm).")
      .from(1, 100)
      .only_if(is("stiffness", {"iso_6336"}))
      .absent("14, steel with standard proportions under more than 100 N/mm");
  return mesh.done();
}

/// Names of the quantities whose quantile can be the error at mesh frequency, and "none".
std::vector<Choice<std::string>> reading_choices() {
  std::vector<Choice<std::string>> list;
  for (const std::string gear : {"pinion_", "wheel_"}) {
    for (const auto* what : {"error", "error_magnitude", "x1", "x2", "envelope", "crest"})
      list.push_back({gear + what, gear + what});
  }
  for (const auto* name : {"sum", "sum_magnitude", "none"}) list.push_back({name, name});
  return list;
}

Table manufacturing_error_table() {
  Declarations t("manufacturing_error",
                 "Tangential composite deviations of both gears as random amplitudes with Rayleigh distribution and "
                 "uniform phase: X₁ = (F′ − f′)/2 once per turn and X₂ = f′/2 once per tooth. One reading of their "
                 "quantile becomes the error at mesh frequency.",
                 &PairInput::manufacturing_error);
  t.on_request();
  const auto deviation = [&](const char* name, double ManufacturingErrorInput::*member, const char* meaning) {
    t.key(name, member, meaning).required().from(0, 1e4);
  };
  deviation("pinion_total_um", &ManufacturingErrorInput::pinion_total,
            "Tangential composite deviation F′ᵢ of the pinion, over a turn (ISO 1328).");
  deviation("pinion_tooth_to_tooth_um", &ManufacturingErrorInput::pinion_tooth_to_tooth,
            "Tooth-to-tooth tangential composite deviation f′ᵢ of the pinion.");
  deviation("wheel_total_um", &ManufacturingErrorInput::wheel_total, "F′ᵢ of the wheel.");
  deviation("wheel_tooth_to_tooth_um", &ManufacturingErrorInput::wheel_tooth_to_tooth, "f′ᵢ of the wheel.");
  t.key("samples", &ManufacturingErrorInput::samples, "Number of draws for each gear.")
      .fallback(10000, "as in the paper")
      .from(100, 1e7);
  t.key("seed", &ManufacturingErrorInput::seed, "Other seeds give other draws.")
      .fallback(1, "any number")
      .from(0, 2147483647);
  t.key("probability", &ManufacturingErrorInput::probability, "Probability of the quantiles.")
      .fallback(0.95, "as in the paper")
      .from(0.01, 0.9999);
  t.key("confidence", &ManufacturingErrorInput::confidence, "Confidence of the intervals around the sample quantiles.")
      .fallback(0.95, "usual")
      .from(0.5, 0.9999);
  t.choice("divisor", &ManufacturingErrorInput::divisor,
           {{"printed", ErrorDivisor::printed}, {"exact", ErrorDivisor::exact}},
           "Scale of the Rayleigh law = deviation / divisor: 6.8 as printed, or 2√(−2 ln 0.003) = 6.817.")
      .fallback("printed", "as rounded in the source");
  t.choice("reading", &ManufacturingErrorInput::reading, reading_choices(),
           "Quantity whose quantile becomes the error at mesh frequency. pinion_ or wheel_ with error (one-sided), "
           "error_magnitude, x1, x2, envelope √(X₁² + X₂²) or crest X₁ + X₂. sum or sum_magnitude of both gears. none: "
           "the law is only reported, and the error is that of errors.mesh_error_um.")
      .fallback("pinion_envelope", "the amplitude of one gear with both terms");
  t.choice("amount", &ManufacturingErrorInput::amount, {{"sample", ErrorAmount::sample}, {"exact", ErrorAmount::exact}},
           "Quantile of the draws, or of the law itself.")
      .fallback("sample", "as in the paper; the report states its confidence interval");
  return t.done();
}

Table transmission_error_table() {
  Declarations shares("transmission_error",
                      "Causes of the transmission error: all causes, the errors alone and the stiffness alone.",
                      &PairInput::transmission_error);
  shares.on_request().only_if(given("[dynamics]"), "the lumped model computes the shares");
  shares
      .key("pinion_torques_Nm", &TransmissionErrorInput::pinion_torques,
           "Torques of the pinion at which the causes are separated; the speed is that of the stage.")
      .not_empty("torque")
      .distinct()
      .required()
      .above(0, 1e9);
  shares
      .key("pinion_speeds_rpm", &TransmissionErrorInput::pinion_speeds,
           "Speeds of the pinion at which the causes are separated as well; the torque is that of the stage.")
      .distinct()
      .fallback(std::vector<double>{}, "none")
      .above(0, 1e6);
  return shares.done();
}

}  // namespace

std::vector<Table> pair_tables() {
  std::vector<Table> tables = {pair_stage_table(),
                               pair_gear_table("pinion", "The driving gear of a pair.", &PairInput::pinion),
                               pair_gear_table("wheel", "The driven gear of a pair.", &PairInput::wheel),
                               pair_mesh_table(),
                               rotor_table(),
                               pair_errors_table(),
                               manufacturing_error_table(),
                               transmission_error_table()};
  auto space = space_tables({.bodies = {{"pinion", Body::pinion, &GravityInput::pinion, &TiltInertiaInput::pinion},
                                        {"wheel", Body::wheel, &GravityInput::wheel, &TiltInertiaInput::wheel}},
                             .frames = KindInSpace::Frames::housing});
  for (auto more : {friction_tables(), std::move(space)})
    std::move(more.begin(), more.end(), std::back_inserter(tables));
  return tables;
}

}  // namespace annulus::app
