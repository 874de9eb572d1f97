#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/modes/structural_damping.h"
#include "dynamics/system/drive_line.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/system/mesh_excitation.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// A 2K-V reducer: sun and planets, each planet on a crank shaft of the output carrier. Arc-tooth (or cycloid) gears on
/// the eccentrics of the cranks roll on the pins of the housing. SI. After [QiFangLi2004, eq. (6)], corrected:
///
///   V = 1/2 k_is (th_i - th_s)^2 +
///       sum_i [1/2 k_p (r_bs th_s + r_bp th_pi - X_pi cos alpha)^2 + 1/2 k_ph (th_pi - th_hi)^2 +
///              1/2 k_ha (X_pi - r_c th_o)^2] +
///       sum_ij 1/2 k_b |(X_aj - a th_hi) v_j + (r_c th_aj - X_pi) t_i|^2 + sum_j 1/2 k_a (X_aj + a z_a th_aj)^2
///
/// The frame is fixed to the output carrier. The cranks stand still in it, at phi_i = 2 pi i/n, with t_i = (-sin phi_i,
/// cos phi_i). v_j = (-sin Theta_j, cos Theta_j) is perpendicular to the eccentricity of gear j, Theta_j = Theta +
/// 2 pi j/m. All th are absolute rotations. X_pi is the displacement of a crank's centre along t_i, X_aj that of an arc
/// gear's centre along v_j. Inertia terms of the turning frame are neglected, as in the paper. A rotation th_o = 1 of
/// the output turns
///   arc gears by 1, cranks and planets by -z_a, sun and input by 1 + (z_p/z_s) z_b (the ratio),
/// X_p = r_c, X_a = -a z_a. So Theta, an angle against the carrier, turns at -(z_a + 1) = -z_b times the output speed.
///
/// All DOFs are lengths: u = r th with r_bs (input, sun), r_bp (planets), a (cranks), r_c (arc gears, output). A value
/// type: change it and assemble it again.
struct TwoKVStage {
  int sun_teeth = 0, planet_teeth = 0;
  int arc_teeth = 0;  ///< z_a
  int pins = 0;       ///< z_b = z_a + 1
  int cranks = 2;     ///< n, with a planet each
  int arc_gears = 2;  ///< m, equally spaced around the eccentric
  double module = 0;
  double pressure_angle = 0;  ///< alpha, rad, of the sun-planet mesh; reference and working centre distance agree
  double eccentricity = 0;    ///< a, m

  double input_inertia = 0, sun_inertia = 0;   ///< kg m^2
  double planet_inertia = 0, planet_mass = 0;  ///< kg m^2, kg, of one; the mass with its crank shaft
  double crank_inertia = 0;                    ///< kg m^2, of one
  double arc_inertia = 0, arc_mass = 0;        ///< kg m^2, kg, of one
  double output_inertia = 0;                   ///< kg m^2, carrier and output

  double input_shaft = 0;     ///< k_is, N m/rad, between input and sun
  double crank_shaft = 0;     ///< k_ph, N m/rad, between a planet and its crank
  double crank_bearing = 0;   ///< k_ha, N/m, of a crank shaft in the carrier, tangential
  double arc_bearing = 0;     ///< k_b, N/m, of an arc gear on one eccentric, isotropic
  MeshExcitation sun_mesh;    ///< k_p, along the line of action; phase 0 as in a StiffnessTable
  MeshExcitation arc_mesh;    ///< k_a, along the tangent of the pitch point, see ArcToothMesh
  double input_support = 0;   ///< N m/rad to the housing; 0: free, `rigid`: held
  double output_support = 0;  ///< likewise; the paper holds the output

  /// Half the total backlash, m, along the line of action and the tangent of the pitch point. Absent: never loses
  /// contact.
  std::optional<double> sun_half_backlash, arc_half_backlash;
  bool damping_without_contact = false;
  /// zeta in c = 2 zeta sqrt(k m_e), 1/m_e = b^T M^-1 b of the element (the mean over its directions in a bearing).
  double mesh_damping_ratio = 0;
  std::optional<double> sun_mesh_damping_ratio{}, arc_mesh_damping_ratio{};  ///< absent: mesh_damping_ratio
  double support_damping_ratio = 0;                                          ///< shafts, bearings and supports
  /// Of single ones of these, the input with its shaft and support; absent: support_damping_ratio.
  std::optional<double> input_damping_ratio{}, crank_shaft_damping_ratio{}, crank_bearing_damping_ratio{},
      arc_bearing_damping_ratio{}, output_damping_ratio{};
  StructuralDamping structural_damping{};

  double crank_angle = 0;    ///< Theta at time 0, rad
  double output_speed = 0;   ///< rad/s, >= 0
  double output_torque = 0;  ///< T, N m, >= 0, load on the output; the input drives with T/ratio

  std::vector<Rotor> rotors;  ///< on input and output

  [[nodiscard]] std::vector<ShaftEnd> shaft_ends() const;
  [[nodiscard]] double ratio() const;                ///< 1 + (z_p/z_s) z_b
  [[nodiscard]] double sun_base_radius() const;      ///< m
  [[nodiscard]] double planet_base_radius() const;   ///< m
  [[nodiscard]] double crank_circle_radius() const;  ///< r_c, m: m (z_s + z_p)/2
  [[nodiscard]] double crank_rate() const;           ///< dTheta/dt, rad/s: -z_b x output speed
  [[nodiscard]] double crank_frequency() const;      ///< Hz, its amount / 2 pi
  [[nodiscard]] double sun_mesh_frequency() const;   ///< Hz: z_p cycles per turn of the crank
  [[nodiscard]] double arc_mesh_frequency() const;   ///< Hz: z_a pins per turn of the crank against the carrier
  [[nodiscard]] double mean_sun_mesh_force() const;  ///< N: T/(ratio n r_bs)
  [[nodiscard]] double mean_arc_mesh_force() const;  ///< N: (T - T/ratio)/(m a z_b), tangential
  [[nodiscard]] double arc_torque() const;           ///< N m about the centre of one arc gear: that force x a z_a

  /// Throws InputError with name and value of the quantity when the stage cannot be assembled.
  void check() const;
};

/// The stage as elements. Theta = crank_angle at time 0 and turns with the crank.
/// - DOFs: input_u, sun_u, planet1_u ..., crank1_u ..., arc1_u ..., output_u, planet1_x ..., arc1_x ... (rigid ones
/// left
///   out).
/// - Meshes: sun_planet1 ..., arc_pins1 ... (delta = -(X_a + a z_a th_a), positive under load), then
///   crank1_arc1_tangential (along t_1), crank1_arc1_radial ...: bearings as linear meshes, whose vectors turn with
///   v_j.
/// - Springs: input_shaft, planet1_shaft, crank1_bearing, ..., input_support_u, output_support_u.
/// - Behind them those of the rotors (with_rotors).
/// Mesh phases follow the crank: sun mesh i at -z_p Theta/2 pi - z_s phi_i/2 pi cycles, pins of arc gear j at
/// -z_a Theta/2 pi - z_b j/m. Throws what `check` throws.
[[nodiscard]] LumpedSystem assemble(const TwoKVStage& stage);

/// Length per radian of every DOF, m; 1 for the translations: angle = displacement / radius.
[[nodiscard]] Eigen::VectorXd dof_radii(const TwoKVStage& stage, const LumpedSystem& system);
/// Motion of all DOFs per radian of the output, m: the motion without deformation.
[[nodiscard]] Eigen::VectorXd rigid_motion(const TwoKVStage& stage, const LumpedSystem& system);

}  // namespace annulus::dynamics
