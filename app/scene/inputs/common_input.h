#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/spatial/stage_bodies.h"
#include "dynamics/system/mesh_excitation.h"
#include "dynamics/time_integration/integrate.h"
#include "fem/choice/wanted_model.h"
#include "geometry/flank_topography.h"

namespace annulus::app {

/// Inputs that several kinds of gear systems have, in SI units.

using Fidelity = fem::WantedModel;
enum class StiffnessShape { computed, constant, harmonic, rectangular, table, iso_6336, closed_form };
enum class MeshDamping { in_contact, always };
enum class TipShortening { none, full };

inline constexpr double rigid = std::numeric_limits<double>::infinity();

struct StageInput {
  std::string kind{};  ///< name of a registered kind of gear system
  int planets = 0;
  double module = 0, pressure_angle = 0, helix_angle = 0, face_width = 0, centre_distance = 0;
  TipShortening tip_shortening = TipShortening::none;
};

struct MaterialInput {
  double youngs_modulus = 0, poisson_ratio = 0, density = 0;
};

/// Where a profile shift comes from.
enum class ShiftSource { given, centre_distance, tip_diameter, root_diameter, span, pins };

/// What all gears have in common.
struct GearInput {
  int teeth = 0;
  double profile_shift = 0;
  ShiftSource shift_from = ShiftSource::given;
  std::optional<double> normal_backlash;                 ///< m, in mesh with its mate
  std::optional<int> span_teeth;                         ///< or spaces
  std::optional<double> span, over_pins, measuring_pin;  ///< m
  std::optional<double> mass, inertia;
  std::optional<double> face_width;                              ///< m, instead of that of [stage]
  double axial_offset = 0;                                       ///< m, of the middle of the face
  std::optional<double> youngs_modulus, poisson_ratio, density;  ///< instead of those of [material]
  std::optional<double> tip_diameter, root_diameter;
  double root_fillet_factor = 0;
  double protuberance = 0;                   ///< m
  std::optional<double> protuberance_angle;  ///< rad
  double tip_chamfer = 0, tip_relief = 0, tip_relief_length = 0, profile_crowning = 0, profile_slope = 0;
  double lead_crowning = 0, lead_slope = 0;
  std::optional<std::string> left_topography, right_topography;  ///< files
  /// Their contents, of the counter-clockwise side of the teeth and of the other; null where there is none.
  std::shared_ptr<const geometry::FlankTopography> leading_flank, trailing_flank;
};

/// What holds the bore of a gear: a rigid hub, or rollers on a rigid pin (of planets).
enum class BoreOn { hub, rollers };

struct HubGearInput : GearInput {
  std::optional<double> bore_diameter;
  BoreOn bore = BoreOn::hub;
};

/// Mesh stiffness prescribed instead of computed.
struct MeshInput {
  StiffnessShape stiffness = StiffnessShape::computed;
  std::optional<double> mean, ripple, duty, phase;
  std::optional<double> half_backlash;  ///< instead of that of [dynamics]
  std::optional<double> damping_ratio;  ///< likewise
  std::optional<std::string> file;
  std::optional<double> single_stiffness;  ///< c' of [ISO6336-1], Pa
};

struct DynamicsInput {
  double half_backlash = 0;
  double mesh_damping_ratio = 0, support_damping_ratio = 0;
  double modal_damping_ratio = 0, rayleigh_mass = 0, rayleigh_stiffness = 0;  ///< 1, 1/s, s
  MeshDamping mesh_damping = MeshDamping::in_contact;
  dynamics::LoadDependence load_dependence = dynamics::LoadDependence::table;
  dynamics::Integrator integrator = dynamics::Integrator::automatic;
  std::optional<int> steps_per_cycle;  ///< runge_kutta_4 only
  std::optional<int> mesh_cycles;
  int starts = 0;                            ///< initial conditions from which other motions are looked for
  std::optional<double> relative_tolerance;  ///< of the time integration; absent: what the accuracy asks for
};

/// An inertia at the end of a shaft beside the gear set.
struct RotorInput {
  std::string name, on;                         ///< on: a body of the gear set or another rotor
  double inertia = 0, shaft = 0;                ///< kg m^2, N m/rad
  std::optional<double> shaft_damping_ratio{};  ///< absent: that of the supports
  double shaft_backlash = 0;                    ///< rad, the whole of it
  std::vector<double> ripple_orders{}, ripple_torques{}, ripple_phases{};  ///< per turn; N m; rad, empty: all 0
  std::vector<double> torque_over_turn{};  ///< N m, equidistant; their mean has no effect
};

}  // namespace annulus::app
