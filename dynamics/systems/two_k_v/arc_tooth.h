#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/stiffness_table.h"

namespace annulus::dynamics {

/// Approach of two parallel cylinders: the constant kappa in w = x (kappa + ln(d/x)), see pin_deflection.
enum class LineApproach {
  handbook,  ///< kappa = 2/3 [Roark2002], cylinders in line contact; the formula of the gear handbooks
  johnson,   ///< kappa = 2 ln 2 - 1 (0.386) [Johnson1985, sec. 5.6]: Hertz pressure, depth to the centres
};

/// The arc-tooth gear on its pins, after [QiFangLi2004, eqs. (1) to (5)].
///
/// The gear turns about O_a, at the eccentricity a from the centre O_b of the pin circle. All contact normals pass
/// through the pitch point P, at a z_b from O_b and r' = a z_a from O_a on the line of centres; a pin at the angle psi
/// from that line, seen from O_b, has the normal
///   n = (R cos psi - a z_b, R sin psi)/|...|  =: (cos beta, sin beta),   lever l = r' sin beta.
/// When the gear moves by (X_a, theta_a), the tooth approaches the pin by delta sin beta. delta = X_a + a z_a theta_a
/// is the displacement of the gear at P and the coordinate of the mesh: F_a = sum F_i sin beta_i, k_a = F_a/delta. The
/// torsional stiffness of [QiFangLi2004, eq. (5)] is k_a r'^2.
struct ArcToothMesh {
  int pins = 0;                  ///< z_b; the gear has one tooth less
  double eccentricity = 0;       ///< a, m
  double pin_circle_radius = 0;  ///< R, m; above a z_b
  double pin_radius = 0;         ///< r_z, m
  double arc_radius = 0;         ///< r, m, of the concave arc that replaces the flank; above r_z. Not printed
  double width = 0;              ///< b, m. Not printed
  double youngs_modulus = 0;     ///< Pa, of gear and pins
  double poisson_ratio = 0.3;
  /// m, removed from the flank along its normal everywhere. Without load only pins near sin beta = 1 touch, the others
  /// after the gear has moved on. 0: all pins on the loaded side touch at once, as [QiFangLi2004, eqs. (2) and (3)]
  /// assume.
  double clearance = 0;
  LineApproach approach = LineApproach::handbook;

  [[nodiscard]] double pitch_radius() const { return eccentricity * (pins - 1); }  ///< r', m
  /// rho = r_z r/(r - r_z), m: 1/rho is the relative curvature of the convex pin in the concave arc.
  [[nodiscard]] double equivalent_radius() const { return pin_radius * arc_radius / (arc_radius - pin_radius); }
  /// Throws InputError with name and value of the quantity.
  void check() const;
};

/// Largest share of the output torque on one of two arc gears, T_a = 0.55 T: errors distribute the torque unevenly.
inline constexpr double uneven_share = 0.55;

/// F_max = 4 T_a/(z r'), N [QiFangLi2004, eq. (3)], with the torque T_a on one gear (N m). Forces rise with the lever,
/// F_i = F_max sin beta_i, on half of the pins. The mean of sin^2 beta over the pin circle is 1/2 wherever P lies
/// within it, so that z means z_b.
[[nodiscard]] double largest_pin_force(const ArcToothMesh& mesh, double torque);
/// Approach of pin and arc under F, m. [QiFangLi2004, eq. (4)] is damaged in print; restored:
///   w = 2(1 - nu^2)/E F/(pi b) (2/3 + ln(16 r_z r/c^2)),  c^2 = (16/pi) 2(1 - nu^2)/E F/b rho
/// c is the Hertz width of the contact (1.60 sqrt(...) in [Roark2002], 4.99e-3 sqrt(...) in mixed units in the
/// handbooks). With x = 2(1 - nu^2)/E F/(pi b) this is x (kappa + ln((r - r_z)/x)): only the difference of the radii
/// counts. Throws InputError for a force beyond the range of the formula (conforming surfaces).
[[nodiscard]] double pin_deflection(const ArcToothMesh& mesh, double force);
/// dF/dw at F, N/m; infinite at 0.
[[nodiscard]] double pin_tangent(const ArcToothMesh& mesh, double force);
/// F at a deflection, N. Throws SolverError beyond the range of the formula (conforming surfaces).
[[nodiscard]] double pin_force(const ArcToothMesh& mesh, double deflection);
/// [QiFangLi2004, eqs. (2), (4), (5)] as printed, in the coordinate of the mesh: one secant stiffness for all pins,
/// k = T_a r'/w(F_max)/r'^2 = (z_b/4) F_max/w(F_max), N/m.
[[nodiscard]] double printed_stiffness(const ArcToothMesh& mesh, double torque);

/// One position of the gear.
struct ArcToothPosition {
  Eigen::VectorXd lever;  ///< l_i, m, one per pin; 0 on the side that lifts off
  Eigen::VectorXd force;  ///< N, one per pin
  int loaded = 0;         ///< pins that carry
  double touch = 0;       ///< m, delta at which the first pin touches
  double deflection = 0;  ///< m, delta under the load, `touch` included
  double secant = 0;      ///< N/m, F_a/(delta - touch)
  double tangent = 0;     ///< N/m
};

/// Equilibrium of one gear under the torque (N m) at `phase` mesh cycles. Pin k is at psi = 2 pi (k + phase)/z_b and
/// loaded where sin psi < 0 (the gear turns with the output and drives it). Torque and levers are taken about O_a.
[[nodiscard]] ArcToothPosition arc_position(const ArcToothMesh& mesh, double torque, double phase);

/// The mesh as a table over phase and tangential force F_a = T_a/r', for `table_stiffness(...)`. Torques (N m per gear)
/// are positive and rise. The unloaded transmission error is `touch` minus its least value, which is backlash. Throws
/// InputError without torques or phases and for torques beyond the range of the line contact.
[[nodiscard]] StiffnessTable arc_stiffness_table(const ArcToothMesh& mesh, const std::vector<double>& torques,
                                                 int phases = 32);

}  // namespace annulus::dynamics
