#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "core/ring_coupling.h"
#include "dynamics/friction/flank_friction.h"
#include "dynamics/modes/structural_damping.h"
#include "dynamics/system/drive_line.h"
#include "dynamics/system/mesh_excitation.h"
#include "dynamics/system/periods.h"
#include "dynamics/system/support.h"
#include "dynamics/systems/planetary/stage_space.h"
#include "geometry/power_flow.h"

namespace annulus::geometry {
class PlanetarySet;
}

namespace annulus::dynamics {

/// A radial deviation and its direction: the vector (cos phase, sin phase) x amount.
struct Deviation {
  double amount = 0;  ///< m
  double phase = 0;   ///< rad
  [[nodiscard]] bool exists() const { return amount != 0; }
};

/// Errors of one body.
///
/// Eccentricity: vector from the centre of rotation to the centre of the toothing. It turns with the body. Its phase is
/// measured in the frame of the body at time 0. For a planet it starts at the line from sun centre to planet centre,
/// for sun, ring and carrier at the x axis (towards planet 0).
///
/// Position: vector from the nominal to the actual centre of rotation, phase from the x axis at time 0. For a planet it
/// is the pin position error and fixed to the carrier; for sun, ring and carrier it is fixed in the housing.
struct BodyErrors {
  Deviation eccentricity;
  Deviation position;
};

/// Sun, ring or carrier. Coordinates x, y (m) in the carrier-fixed frame and u = radius x rotation (m).
struct CentralBody {
  double mass = 0;         ///< kg
  double inertia = 0;      ///< kg m^2 about the axis
  double radius = 0;       ///< m, base radius; the working centre distance for the carrier
  double support = rigid;  ///< N/m to the housing, isotropic; `rigid` drops x and y
  /// N/m in the coordinate u; `rigid` drops u. 0: free to turn (it carries the power).
  double torsional_support = 0;
  BodyErrors errors;
  std::optional<double> damping_ratio{};  ///< of its supports; absent: support_damping_ratio
};

/// All planets share these.
struct PlanetBody {
  double mass = 0;                        ///< kg
  double inertia = 0;                     ///< kg m^2
  double radius = 0;                      ///< m, base radius
  std::optional<double> damping_ratio{};  ///< of their bearings; absent: support_damping_ratio
};

/// Stiffness between a planet and the carrier, N/m, bearing and pin. `rigid` drops the planet's DOF: in that direction
/// it then moves with the carrier, to which its mass is added.
struct PlanetBearing {
  double radial = rigid, tangential = rigid;
  /// m, half of the radial clearance: the bearing then is a RadialBearing, whose stiffnesses are equal and finite.
  double play = 0;
  double pin = rigid;  ///< N/m, in series with a bearing that has play; of others it is part of the stiffnesses
};

/// A planetary stage as lumped masses; SI. Any of sun, carrier and ring may be held or turn. After [HuFangXuShen2021,
/// eqs. (15) to (39)], corrected:
///
///   delta_sn = u_s - x_s sin(phi_n - a_s) + y_s cos(phi_n - a_s) + u_n - x_n sin a_s - y_n cos a_s - e_sn     (15)
///   delta_rn = u_r - x_r sin(phi_n + a_r) + y_r cos(phi_n + a_r) - u_n + x_n sin a_r - y_n cos a_r - e_rn     (16)
///
/// With `space`, further coordinates act as in SpatialStage, whose delta is cos(base helix angle) times this one.
///
/// delta > 0 presses the flanks together; x_n is radial and y_n tangential. A value type: change it and assemble it
/// again.
struct PlanetaryStage {
  CentralBody sun, ring, carrier;
  PlanetBody planet;

  std::vector<double> planet_angles;           ///< phi_n, rad, one per planet, counter-clockwise
  std::vector<PlanetBearing> planet_bearings;  ///< empty: rigid; one: that of every planet; or one per planet
  std::vector<BodyErrors> planet_errors;       ///< empty: none; otherwise one per planet
  /// Errors of the meshes that follow their teeth, of the sun and the ring mesh of every planet; empty: none.
  std::vector<std::vector<ToothError>> sun_tooth_errors, ring_tooth_errors;
  double sun_working_angle = 0;   ///< a_s, rad
  double ring_working_angle = 0;  ///< a_r, rad
  int sun_teeth = 0, planet_teeth = 0, ring_teeth = 0;

  MeshExcitation sun_mesh, ring_mesh;
  /// Mesh cycles (geometry/planetary.h): the sun mesh of planet n is at phase f t - sun_phase_lag[n], its ring mesh at
  /// f t - ring_phase_lag[n] + ring_tooth_offset[n]. Empty: all zero (planets in phase).
  std::vector<double> sun_phase_lag, ring_phase_lag, ring_tooth_offset;

  /// Coupling of the ring meshes through the ring; absent: none.
  ///
  /// With modes of the ring each mode becomes a DOF ring_mode1, ring_mode2, ... (modal amplitude, kg^1/2 m; damping
  /// ratio `support_damping_ratio`). ring_x and ring_y are then measured in the housing, in which the modes stand
  /// still: the ring has no gyroscopic and centripetal terms, and the mesh vectors turn past it with the carrier. The
  /// axes of carrier and ring agree at time 0.
  std::shared_ptr<const RingCoupling> ring_coupling;
  /// Coupling of the sun and the ring mesh of every planet through its rim, m/N: the deflection of one under the force
  /// of the other. Over one cycle of the ring mesh; empty: none. The stiffnesses of both meshes hold for equal forces
  /// and contain it: the deflection of the sun mesh is that of its law, and c (F_r - F_s).
  std::vector<double> planet_coupling;

  /// Half the total normal backlash of the sun and of the ring meshes, m. Absent: the teeth never lose contact (a
  /// linear mesh, which also pulls).
  std::optional<double> sun_half_backlash, ring_half_backlash;
  void set_half_backlash(std::optional<double> both) { sun_half_backlash = ring_half_backlash = both; }
  /// zeta in c = 2 zeta sqrt(k_mean m_e), 1/m_e = r_1^2/I_1 + r_2^2/I_2 [HuFangXuShen2021, eqs. (31), (34)].
  double mesh_damping_ratio = 0;
  std::optional<double> sun_mesh_damping_ratio{}, ring_mesh_damping_ratio{};  ///< absent: mesh_damping_ratio
  double support_damping_ratio = 0;  ///< zeta in c = 2 zeta sqrt(k m), supports and planet bearings
  StructuralDamping structural_damping{};
  template <class Body>
  [[nodiscard]] double damping_ratio_of(const Body& body) const {
    return body.damping_ratio.value_or(support_damping_ratio);
  }
  /// false: damping acts only in contact. true: always, as printed in [HuFangXuShen2021, eq. (30)]; meshes without
  /// contact then pull.
  bool damping_without_contact = false;
  /// Friction on the flanks; absent: none. It moves the ring across the line of action only without modes of the ring.
  std::optional<FlankFriction> sun_friction{}, ring_friction{};
  std::optional<SqueezeFilm> sun_film{}, ring_film{};  ///< within the backlash; absent: none

  /// Omega_c and Omega_r, rad/s, counter-clockwise; the sun's follows (geometry/power_flow.h). Where the carrier turns
  /// clockwise against the ring, the meshes run through their cycles backwards: the carrier then drives, or the ring.
  double carrier_speed = 0, ring_speed = 0;
  /// Omega_c at whose centrifugal force bearings with play have the stiffness of small motions. Absent: carrier_speed.
  std::optional<double> bearing_speed;
  double sun_torque = 0;  ///< T_s, N m, counter-clockwise; T_r = T_s z_r/z_s and T_c = -T_s (1 + z_r/z_s)
  /// The member whose torsional support bears its torque; the torques of the others act as loads. None: a differential.
  std::optional<geometry::StageMember> held = geometry::StageMember::ring;
  /// Terms of the rotating frame: gyroscopic, centripetal, dampers to the housing c(x' - Omega y).
  ///
  /// The centripetal term of a planet is -m Omega^2 (x_n, y_n - u_c), which contains the centrifugal preload of the
  /// planet bearings. A rotation of the whole stage then needs no energy. The printed
  /// -m Omega^2 y_n makes the rotation drift away exponentially.
  bool rotating_frame = true;

  /// Bodies that move along the axis and tilt; absent: the stage is plane. `support` and `planet_bearings` then have no
  /// effect, and the ring has no modes. A mesh is spread over its face (FaceElement).
  std::optional<StageSpace> space;

  std::vector<Rotor> rotors;  ///< on sun, ring and carrier as far as they turn

  [[nodiscard]] const CentralBody& body(geometry::StageMember member) const { return this->*body_of(member); }
  [[nodiscard]] CentralBody& body(geometry::StageMember member) { return this->*body_of(member); }
  [[nodiscard]] std::vector<ShaftEnd> shaft_ends() const;
  [[nodiscard]] PlanetBearing planet_bearing(int n) const;
  /// Force of a planet on its pin under the mean mesh force, N: radial outwards, with the centrifugal force, and in the
  /// sense of rotation.
  [[nodiscard]] Eigen::Vector2d mean_pin_force() const;
  /// Its unit vector, along which bearings with play have their first element; tangential without a force.
  [[nodiscard]] Eigen::Vector2d pin_direction() const;
  [[nodiscard]] int planets() const { return static_cast<int>(planet_angles.size()); }
  [[nodiscard]] double sun_speed() const;        ///< rad/s, counter-clockwise
  [[nodiscard]] double planet_speed() const;     ///< rad/s, counter-clockwise, in the housing
  [[nodiscard]] double mesh_rate() const;        ///< Hz: z_r (Omega_c - Omega_r) / 2 pi
  [[nodiscard]] double mesh_frequency() const;   ///< Hz: |mesh_rate|
  [[nodiscard]] double mean_mesh_force() const;  ///< N: T_s / (N r_bs), of every sun and ring mesh
  [[nodiscard]] double carrier_torque() const;   ///< N m: T_s (1 + z_r/z_s), positive number
  /// Mesh cycles after which excitation and errors repeat. It is the least common multiple of z_p (planet
  /// eccentricities), z_s (sun eccentricity), z_r (ring eccentricity, modes of the ring), of the cycles in which the
  /// housing turns past the carrier (position errors of central bodies; z_r where the ring is held) and the periods of
  /// tables, tooth errors and coupling. `never_repeats` where the speeds of a differential have no such multiple.
  [[nodiscard]] int error_period() const;
  static constexpr int never_repeats = dynamics::never_repeats;

  /// Throws InputError with name and value of the quantity when the stage cannot be assembled.
  void check() const;

 private:
  static CentralBody PlanetaryStage::*body_of(geometry::StageMember member) {
    using geometry::StageMember;
    return member == StageMember::sun    ? &PlanetaryStage::sun
           : member == StageMember::ring ? &PlanetaryStage::ring
                                         : &PlanetaryStage::carrier;
  }
};

/// Terms of the transmission error e (m) of the meshes of planet n from eccentricities and position errors alone, after
/// [HuFangXuShen2021, eq. (22)], corrected. E, th: eccentricity, A: position error.
///   planet:  e_sn = E sin(w t + th + a_s),           e_rn = E sin(w t + th - a_r),   w = -(z_r/z_p) Omega
///            e_sn = A sin(th - phi_n + a_s),         e_rn = A sin(th - phi_n - a_r)
///   sun:     e_sn = -E sin(w t + th - phi_n + a_s),  w = (z_r/z_s) Omega; position: w = -Omega_c
///   ring:    e_rn = -E sin(w t + th - phi_n - a_r),  w = -Omega; position: w = -Omega_c
///   carrier: as a displacement of the planet: + ..., eccentricity w = 0, position w = -Omega_c
/// with Omega = Omega_c - Omega_r. The errors of the back flanks are the negative of those with the negative angle.
[[nodiscard]] std::vector<HarmonicError> sun_mesh_errors(const PlanetaryStage& stage, int n);
[[nodiscard]] std::vector<HarmonicError> ring_mesh_errors(const PlanetaryStage& stage, int n);
[[nodiscard]] std::vector<HarmonicError> sun_mesh_errors(const PlanetaryStage& stage, int n, double working_angle);
[[nodiscard]] std::vector<HarmonicError> ring_mesh_errors(const PlanetaryStage& stage, int n, double working_angle);

/// Fills teeth, base radii, carrier radius, working and planet angles, phase lags and tooth offsets.
void set_kinematics(PlanetaryStage& stage, const geometry::PlanetarySet& set);

/// The stage as elements. DOFs in the order sun, ring, carrier, planet1 ... planetN, each with x, y, u unless rigid,
/// named sun_x, sun_y, sun_u, ..., planet1_x, ..., then ring_mode1, ... Meshes: sun_planet1 ... sun_planetN,
/// ring_planet1 ..., with their friction (with_balanced_friction); then planet1_bearing_along, planet1_bearing_across
/// (the mean pin force) ... of bearings with play. Their planets are loaded by their centrifugal forces. In space: the
/// DOFs of add_bodies_in_space(), and behind all meshes sun_planet1_tilt ... ring_planet1_tilt ..., the tilts of their
/// faces. Last those of the rotors (with_rotors). Throws what `check` throws.
[[nodiscard]] LumpedSystem assemble(const PlanetaryStage& stage);

}  // namespace annulus::dynamics
