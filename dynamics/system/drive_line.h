#pragma once

#include <string>
#include <vector>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// A rotor beside a gear set, at the end of a shaft: a motor, a generator, a load, a flywheel.
struct Rotor {
  std::string name;
  std::string on;                  ///< where its shaft leads to: a body of the gear set, or the rotor before it
  double inertia = 0;              ///< kg m^2
  double shaft_stiffness = 0;      ///< N m/rad
  double shaft_damping_ratio = 0;  ///< zeta in c = 2 zeta sqrt(k J), 1/J = 1/J_1 + 1/J_2 of what the shaft connects
  double half_backlash = 0;        ///< rad, half of the free rotation of the shaft in its couplings
  /// A torque amplitude cos(order x angle + phase) beside that of the body, in its sense; the angle is that by which
  /// the rotor has turned steadily since time 0.
  struct Ripple {
    double order = 0;      ///< per turn
    double amplitude = 0;  ///< N m
    double phase = 0;      ///< rad
  };
  std::vector<Ripple> ripples{};
};

/// A body of a gear set, or one of several such bodies, to which shafts may lead: its DOF NAME_u is radius x
/// rotation.
struct ShaftEnd {
  std::string name;       ///< without number
  double radius = 0;      ///< m
  std::string refusal{};  ///< why no shaft can lead to it: "it is held"; empty: one can
  double speed = 0;       ///< rad/s, of its steady rotation, either sign
  /// N along its DOF: its torque from without over the radius. The constant load of the DOF may contain more, as what
  /// bearings bear at the equilibrium about which they are linear.
  double load = 0;
};

/// A DOF that turns, and its velocity in the steady rotation.
struct Turning {
  std::string dof;
  double velocity = 0;  ///< m/s; 0: nothing turns
};
[[nodiscard]] Turning turning_of(const std::vector<ShaftEnd>& ends);

/// N, of a torque (N m) at a radius (m), which need not be known without torque.
[[nodiscard]] inline double force_at(double radius, double torque) { return torque == 0 ? 0 : torque / radius; }

/// The system with rotors, whose shafts lead to its bodies one behind the other. DOFs ROTOR_u = radius of the body x
/// rotation, behind those of the system; elements ROTOR_shaft behind its meshes, N along u, positive where they pass
/// on the torque of the body. That torque (ShaftEnd::load) acts on the last rotor instead. Ripples of
/// rotors that do not turn are left out. Without rotors the system itself.
///
/// Throws what check_rotors throws, and InputError for names that DOFs or elements of the system have already.
[[nodiscard]] LumpedSystem with_rotors(const LumpedSystem& system, const std::vector<Rotor>& rotors,
                                       const std::vector<ShaftEnd>& ends);
/// Throws InputError for the first rotor that is not usable (rotor_fault), and for inertias and stiffnesses that are
/// not positive.
void check_rotors(const std::vector<Rotor>& rotors, const std::vector<ShaftEnd>& ends);
/// Throws InputError for a ripple of a rotor that does not turn: a response in time needs its period.
void check_ripples(const std::vector<Rotor>& rotors, const std::vector<ShaftEnd>& ends);
/// What is wrong with the name of a rotor and with where its shaft leads to; empty: nothing. Names must be unlike those
/// of bodies and of other rotors; a shaft has to lead to a body or a rotor to which no other one leads.
struct RotorFault {
  std::string name, on;
};
[[nodiscard]] RotorFault rotor_fault(const std::vector<Rotor>& rotors, std::size_t rotor,
                                     const std::vector<ShaftEnd>& ends);

/// Cycles of a frequency (Hz) after which all ripples of rotors that turn repeat; never_repeats where there is no such
/// number.
[[nodiscard]] int ripple_period(const std::vector<Rotor>& rotors, const std::vector<ShaftEnd>& ends, double frequency);

/// The rotors of a body, the nearest first, by their places in `rotors`.
[[nodiscard]] std::vector<std::size_t> rotors_of(const std::vector<Rotor>& rotors, const std::string& body);
/// The body of the gear set to which a rotor belongs.
[[nodiscard]] const ShaftEnd& end_of(const Rotor& rotor, const std::vector<Rotor>& rotors,
                                     const std::vector<ShaftEnd>& ends);
/// 1 for the rotation of a body and its rotors, 0 for all other DOFs: they turn as one.
[[nodiscard]] Eigen::VectorXd turning_as_one(const LumpedSystem& system, const std::vector<Rotor>& rotors,
                                             const std::string& body);

}  // namespace annulus::dynamics
