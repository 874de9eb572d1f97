#include "dynamics/systems/two_k_v/arc_tooth.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

constexpr int root_digits = 50;  // of 53 bits
constexpr std::uintmax_t root_steps = 200;

double approach_constant(LineApproach approach) {
  return approach == LineApproach::handbook ? 2.0 / 3.0 : 2 * std::numbers::ln2 - 1;
}

/// x = 2 (1 - nu^2)/E F/(pi b) per newton, m/N.
double length_per_force(const ArcToothMesh& mesh) {
  return 2 * (1 - mesh.poisson_ratio * mesh.poisson_ratio) / (std::numbers::pi * mesh.youngs_modulus * mesh.width);
}

/// Logarithm of the deflection's bracket, kappa + ln((r - r_z)/x).
double approach_factor(const ArcToothMesh& mesh, double x) {
  return approach_constant(mesh.approach) + std::log((mesh.arc_radius - mesh.pin_radius) / x);
}

/// x at which the half-width of the contact, sqrt(4 x rho), is half the pin radius: beyond, the surfaces conform and
/// Hertz's half spaces are no picture of them.
double largest_length(const ArcToothMesh& mesh) {
  return mesh.pin_radius * mesh.pin_radius / (16 * mesh.equivalent_radius());
}

/// sin beta of every pin on the loaded side, else 0.
Eigen::VectorXd loaded_sines(const ArcToothMesh& mesh, double phase) {
  const double pole = mesh.eccentricity * mesh.pins;
  Eigen::VectorXd sines = Eigen::VectorXd::Zero(mesh.pins);
  for (int k = 0; k < mesh.pins; ++k) {
    const double psi = 2 * std::numbers::pi * (k + phase) / mesh.pins;
    const double x = mesh.pin_circle_radius * std::cos(psi) - pole, y = mesh.pin_circle_radius * std::sin(psi);
    if (y < 0) sines[k] = -y / std::hypot(x, y);
  }
  return sines;
}

struct PinSum {
  double force = 0, tangent = 0;  ///< sum F sin beta, sum dF/dw sin^2 beta
};

PinSum sum_of_pins(const ArcToothMesh& mesh, const Eigen::VectorXd& sines, double delta, Eigen::VectorXd* forces) {
  PinSum sum;
  for (Eigen::Index k = 0; k < sines.size(); ++k) {
    const double deflection = delta * sines[k] - mesh.clearance;
    if (!(deflection > 0)) continue;
    const double force = pin_force(mesh, deflection);
    if (forces) (*forces)[k] = force;
    if (force == 0) continue;  // a deflection below the smallest numbers
    sum.force += force * sines[k];
    sum.tangent += pin_tangent(mesh, force) * sines[k] * sines[k];
  }
  return sum;
}

}  // namespace

void ArcToothMesh::check() const {
  const auto positive = [](double value, const char* name, const char* unit) {
    if (!std::isfinite(value) || !(value > 0))
      throw InputError(fmt::format("arc-tooth mesh: {} {:g} {} must be positive", name, value, unit));
  };
  if (pins < 3) throw InputError(fmt::format("arc-tooth mesh: {} pins; at least 3 are needed", pins));
  positive(eccentricity, "eccentricity", "m");
  positive(pin_radius, "pin radius", "m");
  positive(width, "face width", "m");
  positive(youngs_modulus, "Young's modulus", "Pa");
  if (!(poisson_ratio >= 0 && poisson_ratio < 0.5))
    throw InputError(fmt::format("arc-tooth mesh: Poisson's ratio {:g} must lie in [0, 0.5)", poisson_ratio));
  if (!std::isfinite(pin_circle_radius) || !(pin_circle_radius > eccentricity * pins))
    throw InputError(
        fmt::format("arc-tooth mesh: the pin circle radius {:g} m must exceed eccentricity x pins = {:g} m",
                    pin_circle_radius, eccentricity * pins));
  if (!std::isfinite(arc_radius) || !(arc_radius > pin_radius))
    throw InputError(
        fmt::format("arc-tooth mesh: the radius {:g} m of the concave arc must exceed the pin radius {:g} m",
                    arc_radius, pin_radius));
  if (!std::isfinite(clearance) || !(clearance >= 0))
    throw InputError(fmt::format("arc-tooth mesh: clearance {:g} m must not be negative", clearance));
}

double largest_pin_force(const ArcToothMesh& mesh, double torque) {
  return 4 * torque / (mesh.pins * mesh.pitch_radius());
}

double pin_deflection(const ArcToothMesh& mesh, double force) {
  if (force == 0) return 0;
  const double x = length_per_force(mesh) * force;
  if (!(x > 0 && x <= largest_length(mesh)))
    throw InputError(
        fmt::format("arc-tooth mesh: the line contact formula does not hold at a pin force of {:g} N: pin "
                    "and arc (radii {:g} and {:g} m) conform; reduce the torque, or make the arc gear wider or the "
                    "radius of its arc larger",
                    force, mesh.pin_radius, mesh.arc_radius));
  return x * approach_factor(mesh, x);
}

double pin_tangent(const ArcToothMesh& mesh, double force) {
  if (force == 0) return std::numeric_limits<double>::infinity();
  const double unit = length_per_force(mesh);
  return 1 / (unit * (approach_factor(mesh, unit * force) - 1));
}

double pin_force(const ArcToothMesh& mesh, double deflection) {
  if (deflection == 0) return 0;
  const double top = largest_length(mesh);
  if (!(deflection > 0 && deflection <= top * approach_factor(mesh, top)))
    throw SolverError(
        fmt::format("arc-tooth mesh: no line contact at a pin deflection of {:g} m: pin and arc (radii "
                    "{:g} and {:g} m) conform",
                    deflection, mesh.pin_radius, mesh.arc_radius));
  // Rising and concave: Newton's method from below stays below. x exceeds w/1000 as long as ln(d/x) stays under 999.
  std::uintmax_t steps = root_steps;
  const double x = boost::math::tools::newton_raphson_iterate(
      [&](double length) {
        const double factor = approach_factor(mesh, length);
        return std::make_tuple(length * factor - deflection, factor - 1);
      },
      1e-3 * deflection, 0.0, deflection, root_digits, steps);
  return x / length_per_force(mesh);
}

double printed_stiffness(const ArcToothMesh& mesh, double torque) {
  mesh.check();
  const double force = largest_pin_force(mesh, torque);
  return mesh.pins / 4.0 * force / pin_deflection(mesh, force);
}

ArcToothPosition arc_position(const ArcToothMesh& mesh, double torque, double phase) {
  mesh.check();
  if (!std::isfinite(torque) || !(torque > 0))
    throw InputError(fmt::format("arc-tooth mesh: torque {:g} N m on a gear must be positive", torque));
  const Eigen::VectorXd sines = loaded_sines(mesh, phase);
  const double load = torque / mesh.pitch_radius();
  ArcToothPosition result;
  result.lever = mesh.pitch_radius() * sines;
  result.force = Eigen::VectorXd::Zero(sines.size());
  result.touch = mesh.clearance / sines.maxCoeff();
  // One pin with the whole load deflects at least as far as any share of it does.
  const double high = (mesh.clearance + pin_deflection(mesh, load / sines.maxCoeff())) / sines.maxCoeff();
  std::uintmax_t steps = root_steps;
  const auto [below, above] = boost::math::tools::toms748_solve(
      [&](double delta) { return sum_of_pins(mesh, sines, delta, nullptr).force / load - 1; }, result.touch,
      high * (1 + 1e-9), boost::math::tools::eps_tolerance<double>(root_digits), steps);
  if (steps >= root_steps) throw SolverError(fmt::format("arc-tooth mesh: no equilibrium at phase {:g}", phase));
  result.deflection = (below + above) / 2;
  result.tangent = sum_of_pins(mesh, sines, result.deflection, &result.force).tangent;
  result.loaded = static_cast<int>((result.force.array() > 0).count());
  result.secant = load / (result.deflection - result.touch);
  return result;
}

StiffnessTable arc_stiffness_table(const ArcToothMesh& mesh, const std::vector<double>& torques, int phases) {
  mesh.check();
  if (torques.empty() || phases < 1)
    throw InputError(
        fmt::format("arc-tooth mesh: a table needs a torque and a phase, not {} and {}", torques.size(), phases));
  std::vector<double> loads;
  loads.reserve(torques.size());
  for (const double torque : torques) loads.push_back(torque / mesh.pitch_radius());
  std::vector<StiffnessEntry> entries;
  for (int i = 0; i < phases; ++i)
    for (const double torque : torques) {
      const auto position = arc_position(mesh, torque, static_cast<double>(i) / phases);
      entries.push_back({position.touch, position.deflection, position.secant, position.tangent, 0.0});
    }
  const double backlash = std::min_element(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
                            return a.unloaded_te < b.unloaded_te;
                          })->unloaded_te;
  for (auto& entry : entries) {
    entry.unloaded_te -= backlash;
    entry.lte -= backlash;
  }
  return {"arc_pins", phases, {0.0}, std::move(loads), std::move(entries)};
}

}  // namespace annulus::dynamics
