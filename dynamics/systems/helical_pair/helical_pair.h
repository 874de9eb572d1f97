#pragma once

#include <optional>

#include "dynamics/modes/modes.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/system/mesh_excitation.h"
#include "dynamics/system/support.h"

namespace annulus::dynamics {

/// amount x sin(rate t + phase) of a known rate; measured like the deflection of the mesh. m, rad.
struct ErrorWave {
  double amount = 0, phase = 0;
  [[nodiscard]] bool exists() const { return amount != 0; }
};

/// One gear of a pair. Coordinates y (along the transverse line of action), z (axial) and u = radius x rotation, m.
struct PairGear {
  int teeth = 0;
  double mass = 0;     ///< kg
  double inertia = 0;  ///< kg m^2 about the axis
  double radius = 0;   ///< m, base radius
  /// N/m to the housing; `rigid` drops the DOF.
  double bearing_transverse = rigid, bearing_axial = rigid;
  ErrorWave error;  ///< once per turn of this gear
};

/// A helical gear pair with bending, torsion and axial motion; SI. Models.md B, after "Dynamic calculation and analysis
/// of cylindrical helical gear transmission by considering manufacturing error", eqs. (1) and (10) to (14), corrected.
///
///   delta = cos b (y_1 + u_1 - y_2 + u_2) - sin b (z_1 - z_2) - e ,  F = k(t) g(delta) + c delta'
///   m y_1'' + ... = -F cos b , m z_1'' + ... = F sin b , I/r^2 u_1'' = T/r - F cos b ; the wheel's y and z the other
///   way, its u alike
///
/// 1: pinion, 2: wheel. delta > 0 closes the mesh and is measured along the flanks' common normal; so are e, k and the
/// backlash. The normal of an involute helicoid leans by the *base* helix angle b out of the transverse plane and
/// touches the base cylinders: torque r F cos b and thrust F sin b = T tan(beta)/r_reference then agree with statics.
/// The paper's beta at the reference circle together with base radii overstates the thrust by 1/cos(transverse pressure
/// angle), 7 % here; who wants it sets it as `base_helix_angle`.
///
/// Both rotations are positive where they close the mesh, so turning freely is u_1 = -u_2. A value type.
struct HelicalPair {
  PairGear pinion, wheel;
  double base_helix_angle = 0;  ///< rad; negative: the other hand
  MeshExcitation mesh;          ///< N/m along the normal
  ErrorWave mesh_error;         ///< at mesh frequency
  /// Half the normal backlash, m. Absent: the teeth never part (a linear mesh, pulling included).
  std::optional<double> half_backlash;
  /// xi in c = 2 xi sqrt(k_mean I_1 I_2/(I_1 r_2^2 + I_2 r_1^2)); the printed (11) is no damping constant.
  double mesh_damping_ratio = 0;
  double bearing_damping_ratio = 0;      ///< zeta in c = 2 zeta sqrt(k m)
  bool damping_without_contact = false;  ///< true: as printed, open meshes push and pull

  double pinion_speed = 0;  ///< rad/s, >= 0
  double pinion_torque =
      0;  ///< N m; the wheel bears it times the ratio. Negative: the back flanks, or a mesh that pulls

  [[nodiscard]] double wheel_speed() const;     ///< rad/s
  [[nodiscard]] double wheel_torque() const;    ///< N m, T r_2/r_1, closing the mesh like the pinion's
  [[nodiscard]] double mesh_frequency() const;  ///< Hz: z_1 Omega_1 / 2 pi
  [[nodiscard]] double static_force() const;    ///< N, T / (r_1 cos b), along the normal
  [[nodiscard]] double reduced_mass() const;    ///< kg, 1/m = r_1^2/I_1 + r_2^2/I_2
  /// Deflection (m/N) of the mesh and the bearings in line along the normal, at mean mesh stiffness; under a load F
  /// the rotations approach by u_1 + u_2 = (F compliance + e) / cos b.
  [[nodiscard]] double static_compliance() const;
  /// Whole mesh cycles after which stiffness and errors repeat: z_1 with an error of the pinion, z_2 with one of the
  /// wheel, the period of a table; their least common multiple.
  [[nodiscard]] int error_period() const;
  /// Throws InputError naming the quantity when the pair cannot be assembled.
  void check() const;
};

/// sin b = sin(helix angle at the reference circle) cos(normal pressure angle); rad (ISO 21771).
[[nodiscard]] double base_helix_angle(double helix_angle, double normal_pressure_angle);

/// Mean stiffness (N/m) c' cos(beta) (0.75 eps_alpha + 0.25) b after ISO 6336-1, method B: c' = 14 N/(mm um) is the
/// stiffness of one pair of spur teeth of steel with standard proportions under more than 100 N/mm, beta the helix
/// angle at the reference circle. Meant for eps_alpha >= 1.2 and beta <= 30 degrees. Throws InputError when a width,
/// ratio or stiffness is not positive or eps_alpha is below 1.
[[nodiscard]] double iso_6336_mesh_stiffness(double face_width, double transverse_contact_ratio, double helix_angle,
                                             double single_stiffness = 14e9);

/// The pair as elements: DOFs pinion_y, pinion_z, pinion_u, wheel_y, wheel_z, wheel_u as far as they exist, one
/// mesh "mesh".
[[nodiscard]] LumpedSystem assemble(const HelicalPair& pair);

/// With the mean tangent stiffness of the mesh; the free rotation has 0 Hz.
[[nodiscard]] Modes modes(const HelicalPair& pair);

}  // namespace annulus::dynamics
