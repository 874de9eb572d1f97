#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "fem/problem/strain_gauge.h"
#include "geometry/power_flow.h"

namespace annulus::app {

enum class RimCoupling { automatic, none, statical, elastic };
enum class Structure { traditional, thin_walled, pinned, bolted, splined, clamped };

/// Keys of [stage] that planetary stages alone have.
struct PlanetaryStageInput {
  std::vector<double> planet_angles;                                        ///< rad; empty: equally spaced
  std::optional<geometry::StageMember> held = geometry::StageMember::ring;  ///< absent: none, a differential
  geometry::StageMember drives = geometry::StageMember::sun;
  std::optional<double> power, sun_torque, carrier_torque, ring_torque;  ///< W, N m; exactly one is given
  /// rad/s, counter-clockwise; one is given, two of a differential.
  std::optional<double> sun_speed, carrier_speed, ring_speed;
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

/// How a planet's pin is held. unbending: it counts as rigid. between_walls: both ends clamped. cantilever: one end
/// clamped.
/// flexpin: one end clamped, the planet on a sleeve that stands on the other end and stays parallel.
enum class PinMounting { unbending, between_walls, cantilever, flexpin };

/// N/m; `rigid` drops the DOF. Torsional values are in the coordinate u = base radius x angle.
struct SupportInput {
  double sun = rigid, ring = rigid, carrier = rigid, planet = rigid;
  std::vector<double> planet_radial, planet_tangential;  ///< one per planet; empty: `planet`
  double planet_clearance = 0;                           ///< m, radial clearance
  PinMounting planet_pin = PinMounting::unbending;
  std::optional<double> pin_diameter, pin_length;  ///< m
  /// Absent: rigid of the member that is held, none of the others (torsional_support).
  std::optional<double> sun_torsional, ring_torsional, carrier_torsional;
  /// Damping ratios; absent: that of [dynamics].
  std::optional<double> sun_damping, ring_damping, carrier_damping, planet_damping;

  [[nodiscard]] double planet_bearing(std::vector<double> SupportInput::*direction, std::size_t n) const {
    const auto& own = this->*direction;
    return own.empty() ? planet : own.at(n);
  }
};

/// An eccentricity turns with its body; a position error is fixed in the housing or on the carrier.
struct BodyErrorInput {
  double eccentricity = 0, eccentricity_phase = 0, position = 0, position_phase = 0;
};

struct PlanetaryErrorInput {
  std::vector<double> planet_eccentricity, planet_eccentricity_phase, planet_pin_position, planet_pin_position_phase;
  /// m, one per tooth; of planets for all alike or one list after the other.
  std::vector<double> sun_pitch, planet_pitch, ring_pitch;
  std::optional<int> sun_pitch_class, planet_pitch_class, ring_pitch_class;  ///< they are drawn within
  int pitch_seed = 0;
  BodyErrorInput sun, ring, carrier;
  double sun_planet_misalignment = 0, ring_planet_misalignment = 0;  ///< over the face width, normal to the flanks
};

enum class ToleranceLaw { normal, uniform };

/// Tolerances of the gears and the carrier, and the assemblies drawn within them.
struct ToleranceInput {
  std::optional<int> accuracy_class;                             ///< [ISO1328-1], of gears without their own
  std::optional<int> sun_class, planet_class, ring_class;        ///< instead of it
  std::optional<double> sun_runout, planet_runout, ring_runout;  ///< m, instead of that of the class
  std::optional<double> planet_pin_position;                     ///< m, diameter of the zone
  ToleranceLaw distribution = ToleranceLaw::normal;
  int assemblies = 0, seed = 0;
  std::vector<double> torque_shares;
};

/// A strain gauge on the ring, in its frame.
struct StrainGaugeInput {
  std::string name;
  std::optional<std::string> ring;  ///< absent: all
  fem::StrainGauge::Place place = fem::StrainGauge::Place::root;
  fem::StrainGauge::Direction direction = fem::StrainGauge::Direction::hoop;
  double angle = 0, offset = 0, length = 0;
  std::vector<double> axial_positions;  ///< m, from the middle of the common face; empty: there
};

/// What the scene of a planetary stage has of its own, besides sun and planets (sun_planet_input.h).
struct PlanetaryInput {
  PlanetaryStageInput stage;
  CarrierInput carrier;
  std::vector<RingInput> rings;
  SupportInput supports;
  MeshInput ring_planet;
  RimCoupling rim_coupling = RimCoupling::automatic;  ///< of [dynamics]
  PlanetaryErrorInput errors;
  std::optional<ToleranceInput> tolerances;
  std::vector<StrainGaugeInput> strain_gauges;
};

[[nodiscard]] inline PlanetaryInput& planetary(Scene& scene) { return scene.own<PlanetaryInput>(); }
[[nodiscard]] inline const PlanetaryInput& planetary(const Scene& scene) { return scene.own<PlanetaryInput>(); }

}  // namespace annulus::app
