#pragma once

#include <optional>
#include <vector>

#include "dynamics/friction/flank_friction.h"
#include "dynamics/modes/modes.h"
#include "dynamics/modes/structural_damping.h"
#include "dynamics/spatial/space_bodies.h"
#include "dynamics/system/drive_line.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/system/mesh_excitation.h"
#include "dynamics/system/support.h"

namespace annulus::dynamics {

/// Error amount x sin(rate t + phase), m and rad, along the deflection of the mesh. The rate is known from the gear.
struct ErrorWave {
  double amount = 0, phase = 0;
  [[nodiscard]] bool exists() const { return amount != 0; }
};

/// What a pair has beside its plane where its gears lie in bearings with places, and tilt. Axes: y along the transverse
/// line of action, z along the axes. The working pitch points are, from the axes, at the angle of the line of action
/// with the common tangent. `bearings` are those of pinion and wheel on the housing, instead of the stiffnesses of
/// PairGear.
struct PairSpace : SpaceSupports {
  double working_radius_pinion = 0, working_radius_wheel = 0;  ///< m
  double tilt_inertia_pinion = 0, tilt_inertia_wheel = 0;      ///< kg m^2, about axes across the gears' own
  double mass_place_pinion = 0, mass_place_wheel = 0;          ///< m, z of the centres of mass
  SpreadFace face;                                             ///< gaps normal to the flanks
};

/// One gear of a pair. Coordinates y (along the transverse line of action), z (axial) and u = radius x rotation, m.
struct PairGear {
  int teeth = 0;
  double mass = 0;     ///< kg
  double inertia = 0;  ///< kg m^2 about the axis
  double radius = 0;   ///< m, base radius
  /// N/m to the housing; `rigid` drops the DOF.
  double bearing_transverse = rigid, bearing_axial = rigid;
  ErrorWave error;                        ///< once per turn of this gear
  std::optional<double> damping_ratio{};  ///< of its bearings; absent: that of the pair
};

/// A helical gear pair with bending, torsion and axial motion; SI. After [LiuZhangZhangWangWang2020, eqs. (1) and (10)
/// to (14)], corrected.
///
///   delta = cos b (y_1 + u_1 - y_2 + u_2) - sin b (z_1 - z_2) - e ,  F = k(t) g(delta) + c delta'
///   m y_1'' + ... = -F cos b , m z_1'' + ... = F sin b , I/r^2 u_1'' = T/r - F cos b ; the wheel has y and z the
///   other way, its u the same
///
/// 1: pinion, 2: wheel. delta, e, k and the backlash are measured along the common normal of the flanks; delta > 0
/// presses them together. The normal of an involute helicoid is inclined by the *base* helix angle b to the transverse
/// plane and touches the base cylinders. Torque r F cos b and thrust F sin b = T tan(beta)/r_reference then agree with
/// statics.
///
/// The paper combines beta at the reference circle with base radii, which overstates the thrust by
/// 1/cos(transverse pressure angle), 7 % for its pair. That variant is obtained with beta as `base_helix_angle`.
///
/// Both rotations are positive where the flanks approach, so free rotation is u_1 = -u_2. A value type.
struct HelicalPair {
  PairGear pinion, wheel;
  double base_helix_angle = 0;  ///< rad; negative: the other hand
  double working_angle = 0;     ///< rad, transverse; friction and pairs in space need it
  MeshExcitation mesh;          ///< N/m along the normal
  ErrorWave mesh_error;         ///< at mesh frequency
  /// Half the normal backlash, m. Absent: the teeth never lose contact (a linear mesh, which also pulls).
  std::optional<double> half_backlash;
  /// xi in c = 2 xi sqrt(k_mean I_1 I_2/(I_1 r_2^2 + I_2 r_1^2)). [LiuZhangZhangWangWang2020, eq. (11)] is not a
  /// damping constant.
  double mesh_damping_ratio = 0;
  double bearing_damping_ratio = 0;  ///< zeta in c = 2 zeta sqrt(k m)
  StructuralDamping structural_damping{};
  bool damping_without_contact = false;     ///< true: as printed, meshes without contact push and pull
  std::optional<FlankFriction> friction{};  ///< on the flanks; absent: none
  std::optional<SqueezeFilm> film{};        ///< within the backlash; absent: none

  double pinion_speed = 0;  ///< rad/s, >= 0
  /// N m; the torque of the wheel is this times the ratio. Negative: the back flanks, or a mesh that pulls.
  double pinion_torque = 0;
  std::optional<PairSpace> space{};  ///< absent: the gears neither move off the line of action nor tilt
  std::vector<Rotor> rotors;         ///< on pinion and wheel

  [[nodiscard]] std::vector<ShaftEnd> shaft_ends() const;
  [[nodiscard]] double wheel_speed() const;     ///< rad/s
  [[nodiscard]] double wheel_torque() const;    ///< N m, T r_2/r_1, with the sign of the pinion's
  [[nodiscard]] double mesh_frequency() const;  ///< Hz: z_1 Omega_1 / 2 pi
  [[nodiscard]] double static_force() const;    ///< N, T / (r_1 cos b), along the normal
  [[nodiscard]] double reduced_mass() const;    ///< kg, 1/m = r_1^2/I_1 + r_2^2/I_2
  /// Compliance (m/N) of mesh and bearings in series along the normal, at mean mesh stiffness. Under a load F the
  /// rotations approach by u_1 + u_2 = (F compliance + e) / cos b.
  [[nodiscard]] double static_compliance() const;
  /// Mesh cycles after which stiffness and errors repeat: the least common multiple of z_1 (error of the pinion), z_2
  /// (error of the wheel) and the period of a table.
  [[nodiscard]] int error_period() const;
  /// Throws InputError with name and value of the quantity when the pair cannot be assembled.
  void check() const;
};

/// sin b = sin(helix angle at the reference circle) cos(normal pressure angle); rad [ISO21771].
[[nodiscard]] double base_helix_angle(double helix_angle, double normal_pressure_angle);

struct Iso6336Mesh {
  double face_width = 0;                ///< b, m
  double transverse_contact_ratio = 0;  ///< eps_alpha, at least 1
  double helix_angle = 0;               ///< beta, rad, at the reference circle
  /// c', N/m^2: one pair of spur teeth of steel with standard proportions under more than 100 N/mm.
  double single_stiffness = 14e9;
};
/// Mean mesh stiffness (N/m) c' cos(beta) (0.75 eps_alpha + 0.25) b, [ISO6336-1, method B]. Meant for
/// eps_alpha >= 1.2 and beta <= 30 degrees. Throws InputError when a width, ratio or stiffness is not positive, when
/// eps_alpha is below 1 or the helix angle not below 90 degrees.
[[nodiscard]] double iso_6336_mesh_stiffness(const Iso6336Mesh& mesh);

/// The pair as elements: DOFs pinion_y, pinion_z, pinion_u, wheel_y, wheel_z, wheel_u (rigid ones left out) and one
/// mesh "mesh" with its friction (with_balanced_friction); then those of the rotors (with_rotors). In space those of
/// add_space_bodies(), and a mesh "mesh_tilt" of what the mesh approaches at the end of the face by more than in its
/// middle. Throws what `check` throws.
[[nodiscard]] LumpedSystem assemble(const HelicalPair& pair);

/// Coordinates of the bearings of a pair in space, in their places.
[[nodiscard]] std::vector<std::vector<LinearForm>> bearing_coordinates(const HelicalPair& pair);

/// Modes with the mean tangent stiffness of the mesh; the free rotation has 0 Hz.
[[nodiscard]] Modes modes(const HelicalPair& pair);

}  // namespace annulus::dynamics
