#include "app/scene/scene_declare.h"
#include "app/scene/scene_schema.h"

namespace annulus::app {

namespace {

const std::vector<StageKind> of_pairs = {StageKind::helical_pair};

Table pair_gear_table(const char* path, const char* meaning, HubGearInput& (*gear)(Scene&, std::size_t),
                      PairGearInput& (*section)(Scene&, std::size_t)) {
  Table table = hub_gear_table(path, meaning, of_pairs, gear);
  for (auto& p : table.parameters) {
    if (p.name == "inertia_kg_m2") p.note = "½ m r² of a solid disc, r: reference circle";
  }
  Declarations<PairGearInput> bearings(path, meaning, section);
  const auto bearing = [&](const char* name, double PairGearInput::*member, const char* what) {
    bearings.key(name, member, what)
        .fallback(rigid, "rigid: the degree of freedom is dropped")
        .above(0, 1e15)
        .infinite();
  };
  bearing("bearing_transverse_N_per_m", &PairGearInput::bearing_transverse,
          "Bearings and shaft along the transverse line of action.");
  bearing("bearing_axial_N_per_m", &PairGearInput::bearing_axial, "Axial bearing.");
  for (auto& p : bearings.done().parameters) table.parameters.push_back(std::move(p));
  return table;
}

Table stiffness_table_of_pairs() {
  Table table = mesh_table(
      "mesh.pinion_wheel",
      "Stiffness of the mesh along the normal of the flanks. computed: finite elements (`model`); iso_6336: mean after "
      "ISO 6336-1 method B, with `ripple` if one is given; closed_form: tooth formulas of the transverse section, "
      "staggered along the helix.",
      of_pairs, [](Scene& s, std::size_t) -> MeshInput& { return s.pinion_wheel; });
  Declarations<MeshInput> more("mesh.pinion_wheel", "",
                               [](Scene& s, std::size_t) -> MeshInput& { return s.pinion_wheel; });
  more.key("single_stiffness_GPa", &MeshInput::single_stiffness,
           "iso_6336: stiffness c′ of one pair of spur teeth per unit of face width; 1 GPa = 1 N/(mm µm).")
      .from(1, 100)
      .absent("iso_6336: 14, steel with standard proportions under more than 100 N/mm");
  for (auto& p : more.done().parameters) table.parameters.push_back(std::move(p));
  for (auto& p : table.parameters) {
    if (p.name == "ripple") p.note = "needed by harmonic and rectangular; iso_6336: constant";
    if (p.name == "file") p.meaning += " Its forces and errors are those of the transverse section.";
  }
  return table;
}

Table manufacturing_error_table() {
  Declarations<ManufacturingErrorInput> t(
      "manufacturing_error",
      "Tangential composite deviations of both gears as random amplitudes: X₁ = (F′ − f′)/2 once per turn and X₂ = "
      "f′/2 "
      "once per tooth, Rayleigh, under a uniform phase. One reading of their quantile becomes the error at mesh "
      "frequency.",
      [](Scene& s, std::size_t) -> ManufacturingErrorInput& {
        if (!s.manufacturing_error) s.manufacturing_error.emplace();
        return *s.manufacturing_error;
      });
  t.on_request().only(of_pairs);
  const auto deviation = [&](const char* name, double ManufacturingErrorInput::*member, const char* meaning) {
    t.key(name, member, meaning).required().from(0, 1e4);
  };
  deviation("pinion_total_um", &ManufacturingErrorInput::pinion_total,
            "Tangential composite deviation F′ᵢ of the pinion, over a turn (ISO 1328).");
  deviation("pinion_tooth_to_tooth_um", &ManufacturingErrorInput::pinion_tooth_to_tooth,
            "Tooth-to-tooth tangential composite deviation f′ᵢ of the pinion.");
  deviation("wheel_total_um", &ManufacturingErrorInput::wheel_total, "F′ᵢ of the wheel.");
  deviation("wheel_tooth_to_tooth_um", &ManufacturingErrorInput::wheel_tooth_to_tooth, "f′ᵢ of the wheel.");
  t.key("samples", &ManufacturingErrorInput::samples, "Draws of each gear.")
      .fallback(10000L, "as in the paper")
      .from(100, 1e7);
  t.key("seed", &ManufacturingErrorInput::seed, "Other seeds give other draws.")
      .fallback(1L, "any number will do")
      .from(0, 2147483647);
  t.key("probability", &ManufacturingErrorInput::probability, "Of the quantiles.")
      .fallback(0.95, "as in the paper")
      .from(0.01, 0.9999);
  t.key("confidence", &ManufacturingErrorInput::confidence, "Of the intervals around the sample quantiles.")
      .fallback(0.95, "usual")
      .from(0.5, 0.9999);
  t.choice("divisor", &ManufacturingErrorInput::divisor,
           {{"printed", ErrorDivisor::printed}, {"exact", ErrorDivisor::exact}},
           "Scale of the Rayleigh law = deviation / divisor: 6.8 as printed, or 2√(−2 ln 0.003) = 6.817.")
      .fallback(std::string("printed"), "the source's rounding");
  // Their choices are names, kept as text: the law itself names its readings.
  t.key("reading", &ManufacturingErrorInput::reading,
        "Which quantity's quantile becomes the error at mesh frequency: pinion_ or wheel_ with error (one-sided), "
        "error_magnitude, x1, x2, envelope √(X₁² + X₂²) or crest X₁ + X₂; sum or sum_magnitude of both gears; none: "
        "the law is reported, the error is given by errors.mesh_error_um.")
      .fallback(std::string("pinion_envelope"), "the amplitude of one gear, both terms");
  t.choice("amount", &ManufacturingErrorInput::amount, {{"sample", ErrorAmount::sample}, {"exact", ErrorAmount::exact}},
           "Quantile of the draws, or of the law itself.")
      .fallback(std::string("sample"), "as in the paper; its confidence interval stands beside it");
  return t.done();
}

}  // namespace

void declare_pair(std::vector<Table>& tables) {
  tables.push_back(pair_gear_table(
      "pinion", "The driving gear of a pair.", [](Scene& s, std::size_t) -> HubGearInput& { return s.pinion; },
      [](Scene& s, std::size_t) -> PairGearInput& { return s.pinion; }));
  tables.push_back(pair_gear_table(
      "wheel", "The driven gear of a pair.", [](Scene& s, std::size_t) -> HubGearInput& { return s.wheel; },
      [](Scene& s, std::size_t) -> PairGearInput& { return s.wheel; }));
  tables.push_back(stiffness_table_of_pairs());
  tables.push_back(manufacturing_error_table());
  Declarations<TransmissionErrorInput> shares(
      "transmission_error",
      "Where the transmission error comes from: with all causes, with the errors alone and with the stiffness alone.",
      [](Scene& s, std::size_t) -> TransmissionErrorInput& {
        if (!s.transmission_error) s.transmission_error.emplace();
        return *s.transmission_error;
      });
  shares.on_request().only(of_pairs);
  shares
      .key("pinion_torques_Nm", &TransmissionErrorInput::pinion_torques,
           "Torques of the pinion at which it is asked; the speed is that of the stage.")
      .required()
      .above(0, 1e9);
  shares
      .key("pinion_speeds_rpm", &TransmissionErrorInput::pinion_speeds,
           "Speeds of the pinion at which the causes are told apart as well; the torque is that of the stage.")
      .fallback(std::vector<double>{}, "not asked for")
      .above(0, 1e6);
  tables.push_back(shares.done());
}

}  // namespace annulus::app
