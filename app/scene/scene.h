#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene_value.h"
#include "dynamics/system/mesh_excitation.h"
#include "dynamics/systems/two_k_v/arc_tooth.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::app {

/// What the user asks for, checked and in SI units. Every member is declared to the file format, with its key, unit,
/// default, bounds and meaning, in scene_schema.cc and nowhere else.

enum class Compare { none, computed };
enum class StageKind { planetary, helical_pair, two_k_v };
enum class Fidelity { automatic, closed_form, plane, solid, resolved };
enum class Structure { traditional, thin_walled, pinned, bolted, splined, clamped };
enum class StiffnessShape { computed, constant, harmonic, rectangular, table, iso_6336, closed_form };
enum class MeshDamping { in_contact, always };
enum class RimCoupling { automatic, none, statical, elastic };
enum class SweepScale { linear, logarithmic };
enum class ErrorPhases { given, unknown };
enum class Goal { smallest, largest };
enum class RandomKind { uniform, normal, lognormal };
enum class ErrorDivisor { printed, exact };
enum class ErrorAmount { sample, exact };

inline constexpr double rigid = std::numeric_limits<double>::infinity();

struct StageInput {
  StageKind kind = StageKind::planetary;
  int planets = 0;
  std::vector<double> planet_angles;  ///< rad; empty: equally spaced
  double module = 0, pressure_angle = 0, helix_angle = 0, face_width = 0, centre_distance = 0;
  double power = 0;
  std::optional<double> sun_speed, carrier_speed;  ///< rad/s; exactly one is given
  double pinion_torque = 0, pinion_speed = 0;      ///< helical_pair
};

struct MaterialInput {
  double youngs_modulus = 0, poisson_ratio = 0, density = 0;
};

/// What sun, planet and ring have in common.
struct GearInput {
  int teeth = 0;
  double profile_shift = 0;
  std::optional<double> mass, inertia;
  std::optional<double> tip_diameter, root_diameter;
  double root_fillet_factor = 0;
  double tip_relief = 0, tip_relief_length = 0, profile_crowning = 0;
  double lead_crowning = 0, lead_slope = 0;
};

struct HubGearInput : GearInput {
  std::optional<double> bore_diameter;
};

/// A gear of a helical pair; its bearings: `rigid` drops the DOF.
struct PairGearInput : HubGearInput {
  double bearing_transverse = rigid, bearing_axial = rigid;
};

struct CarrierInput {
  std::optional<double> mass, inertia;
};

struct RingInput : GearInput {
  std::string name;
  Structure structure = Structure::traditional;
  std::optional<double> outside_diameter, rim_thickness;                            ///< exactly one is given
  std::optional<double> flange_width, flange_diameter;                              ///< both or none
  std::optional<double> free_length, sleeve_thickness, hoop_width, hoop_thickness;  ///< hoop: both or none
  std::optional<int> pins;                                                          ///< this or `pin_angles`
  std::vector<double> pin_angles;
  std::optional<double> first_pin_angle, pin_diameter, pin_clearance, pin_free_span, housing_clearance;
  std::optional<double> pin_radial_stiffness, pin_tangential_stiffness;
  std::optional<int> splines;
  std::optional<double> first_spline_angle, spline_flank_angle, spline_clearance, spline_stiffness;
  std::optional<int> bolts, dowels;  ///< dowels: with their diameter or none
  std::optional<double> clamp_inner_diameter, bolt_circle_diameter, bolt_diameter, first_bolt_angle, dowel_diameter;

  [[nodiscard]] bool has_pins() const { return structure == Structure::pinned || structure == Structure::bolted; }
  [[nodiscard]] int pin_count() const {
    return pin_angles.empty() ? pins.value_or(0) : static_cast<int>(pin_angles.size());
  }
};

/// An eccentricity turns with its body, an installation error stands still in the housing (or on the carrier).
struct ErrorInput {
  std::vector<double> planet_eccentricity, planet_eccentricity_phase, planet_installation, planet_installation_phase;
  double sun_eccentricity = 0, sun_eccentricity_phase = 0, sun_installation = 0, sun_installation_phase = 0;
  double ring_eccentricity = 0, ring_eccentricity_phase = 0, ring_installation = 0, ring_installation_phase = 0;
  double carrier_eccentricity = 0, carrier_eccentricity_phase = 0;
  double carrier_installation = 0, carrier_installation_phase = 0;
  double sun_planet_misalignment = 0, ring_planet_misalignment = 0;  ///< over the face width, normal to the flanks
  // Of a helical pair: waves along the normal of the flanks, at mesh frequency and once per turn.
  std::optional<double> mesh_error;
  double mesh_error_phase = 0;
  double pinion_error = 0, pinion_error_phase = 0, wheel_error = 0, wheel_error_phase = 0;
  double pinion_wheel_misalignment = 0;
};

/// Composite deviations of both gears of a pair as random amplitudes (dynamics/manufacturing_error.h).
struct ManufacturingErrorInput {
  double pinion_total = 0, pinion_tooth_to_tooth = 0, wheel_total = 0, wheel_tooth_to_tooth = 0;
  int samples = 0, seed = 0;
  double probability = 0, confidence = 0;
  ErrorDivisor divisor = ErrorDivisor::printed;
  std::string reading;  ///< name of the one that becomes the error at mesh frequency; "none"
  ErrorAmount amount = ErrorAmount::sample;
};

/// Asks where the motion of a pair comes from, at these torques and speeds of the pinion.
struct TransmissionErrorInput {
  std::vector<double> pinion_torques, pinion_speeds;
};

/// N/m; `rigid` drops the DOF. Torsional values are in the coordinate u = base radius x angle.
struct SupportInput {
  double sun = rigid, ring = rigid, carrier = rigid, planet = rigid;
  double sun_torsional = 0, ring_torsional = rigid, carrier_torsional = 0;
};

/// Mesh stiffness given instead of computed.
struct MeshInput {
  StiffnessShape stiffness = StiffnessShape::computed;
  Compare compare = Compare::none;  ///< two_k_v only
  std::optional<double> mean, ripple, duty, phase;
  std::optional<double> half_backlash;  ///< instead of that of [dynamics]
  std::optional<std::string> file;
  std::optional<double> single_stiffness;  ///< c' of ISO 6336-1, Pa
};

/// A crank shaft of a 2K-V stage: its planet sits on one end, its eccentrics carry the arc gears.
struct CrankInput {
  std::optional<double> inertia, shaft, bearing;  ///< kg m^2; N m/rad planet to eccentrics; N/m in the carrier
  double angle = 0;                               ///< of the eccentrics at time 0, rad
};

/// The arc-tooth gears of a 2K-V stage and the pins of the housing.
struct ArcGearInput {
  int count = 0, pins = 0;
  double eccentricity = 0;
  std::optional<double> pin_circle_diameter, pin_diameter, arc_radius, width;
  double clearance = 0;
  dynamics::LineApproach approach = dynamics::LineApproach::handbook;
  std::optional<double> mass, inertia, bearing;  ///< of one; N/m on one eccentric
};

struct InputShaftInput {
  std::optional<double> inertia, shaft;  ///< kg m^2; N m/rad to the sun
  double support = 0;                    ///< N m/rad; 0: free
};

struct OutputInput {
  double torque = 0, speed = 0;
  std::optional<double> inertia;
  double support = 0;  ///< N m/rad; `rigid`: held
};

struct DynamicsInput {
  double half_backlash = 0;
  double mesh_damping_ratio = 0, support_damping_ratio = 0;
  MeshDamping mesh_damping = MeshDamping::in_contact;
  dynamics::LoadDependence load_dependence = dynamics::LoadDependence::table;
  RimCoupling rim_coupling = RimCoupling::automatic;
  dynamics::Integrator integrator = dynamics::Integrator::automatic;
  std::optional<int> steps_per_cycle;  ///< runge_kutta_4 only
  std::optional<int> mesh_cycles;
  std::optional<double> relative_tolerance;  ///< of the time integration; absent: what the accuracy asks for
};

/// One input run through a row of values. Values of studies are in the unit of their input, as in the file.
struct SweepInput {
  std::string input;               ///< key path (overrides.h)
  std::optional<double> from, to;  ///< these and `count`, or `values`
  std::optional<int> count;
  SweepScale scale = SweepScale::linear;
  std::vector<double> values;

  [[nodiscard]] std::vector<double> points() const;
};

/// Two inputs run through all combinations of their values.
struct GridInput {
  SweepInput x, y;
};

/// An uncertain input.
struct RandomInput {
  std::string input;  ///< key path; `[*]` draws for every planet by itself
  RandomKind distribution = RandomKind::uniform;
  std::optional<double> low, high, mean, deviation;
};

struct MonteCarloInput {
  int samples = 0, seed = 0;
  ErrorPhases phases = ErrorPhases::unknown;
};

/// An input that an optimiser may change.
struct VariableInput {
  std::string input;  ///< key path
  double low = 0, high = 0;
  SweepScale scale = SweepScale::linear;
};

struct OptimiseInput {
  std::vector<std::string> objective;  ///< columns of figures
  std::vector<double> weights;         ///< one per figure; empty: their mean
  Goal goal = Goal::smallest;
  std::optional<std::string> ring;      ///< absent: the first one
  std::vector<std::string> optimisers;  ///< names of dynamics::Optimiser
  int generations = 0, population = 0, repeats = 0, seed = 0;
  double elite = 0, crossover = 0, mutation = 0;
  int starts = 0;  ///< initial conditions tried before and after
};

struct SensitivityInput {
  std::vector<std::string> inputs;  ///< empty: the supports, damping ratios and backlash
  double factor = 0;
};

struct Scene {
  std::filesystem::path file;
  std::string title;
  double accuracy = 0;
  Fidelity fidelity = Fidelity::automatic;
  std::optional<std::string> reference;
  StageInput stage;
  MaterialInput material;
  HubGearInput sun, planet;
  PairGearInput pinion, wheel;
  CarrierInput carrier;
  CrankInput crank;
  ArcGearInput arc_gear;
  MeshInput arc_pins;
  InputShaftInput input;
  OutputInput output;
  std::vector<RingInput> rings;
  ErrorInput errors;
  SupportInput supports;
  MeshInput sun_planet, ring_planet, pinion_wheel;
  std::optional<ManufacturingErrorInput> manufacturing_error;
  std::optional<TransmissionErrorInput> transmission_error;
  std::optional<DynamicsInput> dynamics;  ///< absent: no dynamics wanted
  std::vector<SweepInput> sweeps;
  std::vector<GridInput> grids;
  std::optional<MonteCarloInput> monte_carlo;
  std::vector<RandomInput> random_inputs;
  std::optional<SensitivityInput> sensitivity;
  std::optional<OptimiseInput> optimise;
  std::vector<VariableInput> variables;  ///< of [optimise]

  /// The file as read, from which changed scenes are made (overrides.h). Empty in a changed scene, which has no studies
  /// of its own.
  std::string text;

  std::vector<Input> inputs;                   ///< every input with its origin, in the order of the schema
  std::map<std::string, std::string> assumed;  ///< key -> reason, as declared in [assumed]
};

/// Reads and checks a scene file. Throws SceneError with *all* problems found.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file);
/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Scene parse_scene(const std::string& text, const std::filesystem::path& name);

}  // namespace annulus::app
