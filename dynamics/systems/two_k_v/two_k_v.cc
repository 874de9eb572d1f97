#include "dynamics/systems/two_k_v/two_k_v.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace annulus::dynamics {

double TwoKVStage::ratio() const { return 1 + static_cast<double>(planet_teeth) / sun_teeth * pins; }
double TwoKVStage::sun_base_radius() const { return module * sun_teeth / 2 * std::cos(pressure_angle); }
double TwoKVStage::planet_base_radius() const { return module * planet_teeth / 2 * std::cos(pressure_angle); }
double TwoKVStage::crank_circle_radius() const { return module * (sun_teeth + planet_teeth) / 2; }
double TwoKVStage::crank_rate() const { return -pins * output_speed; }
double TwoKVStage::crank_frequency() const { return pins * output_speed / (2 * std::numbers::pi); }
double TwoKVStage::sun_mesh_frequency() const { return planet_teeth * crank_frequency(); }
double TwoKVStage::arc_mesh_frequency() const { return arc_teeth * crank_frequency(); }
double TwoKVStage::mean_sun_mesh_force() const { return output_torque / (ratio() * cranks * sun_base_radius()); }
double TwoKVStage::mean_arc_mesh_force() const {
  return output_torque * (1 - 1 / ratio()) / (arc_gears * eccentricity * pins);
}
double TwoKVStage::arc_torque() const { return mean_arc_mesh_force() * eccentricity * arc_teeth; }

void TwoKVStage::check() const {
  const auto refuse = [](const std::string& what) { throw InputError("2K-V stage: " + what); };
  const auto positive = [&](double value, const char* name, const char* unit) {
    if (!std::isfinite(value) || !(value > 0)) refuse(fmt::format("{} {:g} {} must be positive", name, value, unit));
  };
  const auto not_negative = [&](double value, const char* name, const char* unit) {
    if (!(value >= 0) || std::isinf(value))
      refuse(fmt::format("{} {:g} {} must be zero or positive and finite", name, value, unit));
  };
  const auto support = [&](double value, const char* name) {
    if (!(value >= 0))
      refuse(fmt::format("{} {:g} N m/rad must be zero or positive, or infinite (fixed)", name, value));
  };
  const auto at_least = [&](int value, int least, const char* name) {
    if (value < least) refuse(fmt::format("{} {}; at least {} needed", value, name, least));
  };
  at_least(sun_teeth, 1, "teeth of the sun");
  at_least(planet_teeth, 1, "teeth of a planet");
  at_least(arc_teeth, 1, "teeth of an arc gear");
  at_least(cranks, 1, "cranks");
  at_least(arc_gears, 1, "arc gears");
  if (pins != arc_teeth + 1)
    refuse(
        fmt::format("{} pins with {} teeth of the arc gear: there must be one pin more than teeth", pins, arc_teeth));
  positive(module, "module", "m");
  if (!(pressure_angle > 0 && pressure_angle < std::numbers::pi / 3))
    refuse(fmt::format("pressure angle {:g} rad must lie between 0 and 60 degrees", pressure_angle));
  positive(eccentricity, "eccentricity", "m");
  positive(input_inertia, "input inertia", "kg m^2");
  positive(sun_inertia, "sun inertia", "kg m^2");
  positive(planet_inertia, "planet inertia", "kg m^2");
  positive(planet_mass, "planet mass", "kg");
  positive(crank_inertia, "crank inertia", "kg m^2");
  positive(arc_inertia, "arc gear inertia", "kg m^2");
  positive(arc_mass, "arc gear mass", "kg");
  positive(output_inertia, "output inertia", "kg m^2");
  positive(input_shaft, "input shaft stiffness", "N m/rad");
  positive(crank_shaft, "crank shaft stiffness", "N m/rad");
  positive(crank_bearing, "crank bearing stiffness", "N/m");
  positive(arc_bearing, "arc gear bearing stiffness", "N/m");
  dynamics::check(sun_mesh, "2K-V stage: sun mesh");
  dynamics::check(arc_mesh, "2K-V stage: arc mesh");
  support(input_support, "input support");
  support(output_support, "output support");
  not_negative(mesh_damping_ratio, "mesh damping ratio", "");
  not_negative(support_damping_ratio, "support damping ratio", "");
  not_negative(sun_mesh_damping_ratio.value_or(0), "damping ratio of the sun meshes", "");
  not_negative(arc_mesh_damping_ratio.value_or(0), "damping ratio of the arc meshes", "");
  structural_damping.check();
  not_negative(sun_half_backlash.value_or(0), "half backlash of the sun mesh", "m");
  not_negative(arc_half_backlash.value_or(0), "half backlash of the arc mesh", "m");
  if (!std::isfinite(crank_angle)) refuse(fmt::format("crank angle {} rad must be finite", crank_angle));
  not_negative(output_speed, "output speed", "rad/s");
  not_negative(output_torque, "output torque", "N m");
  check_rotors(rotors, shaft_ends());
}

std::vector<ShaftEnd> TwoKVStage::shaft_ends() const {
  const auto refusal = [](double support) { return support == rigid ? "it is held" : ""; };
  const double sun = sun_base_radius(), crank = crank_circle_radius();
  std::vector<ShaftEnd> ends{{"input", sun, refusal(input_support)},
                             {"output", crank, refusal(output_support), output_speed, force_at(crank, -output_torque)}};
  if (sun_teeth > 0) {
    ends[0].speed = output_speed * ratio();
    ends[0].load = force_at(ratio() * sun, output_torque);
  }
  for (const char* inner : {"sun", "planet", "crank", "arc"}) ends.push_back({inner, 0, "it is inside the reducer"});
  return ends;
}

namespace {

/// The end to which a rotor belongs that has this DOF; nothing for other DOFs.
std::optional<ShaftEnd> end_of_rotor(const TwoKVStage& stage, const std::string& dof) {
  for (const auto& rotor : stage.rotors)
    if (dof == rotor.name + "_u") return end_of(rotor, stage.rotors, stage.shaft_ends());
  return std::nullopt;
}

}  // namespace

Eigen::VectorXd dof_radii(const TwoKVStage& stage, const LumpedSystem& system) {
  Eigen::VectorXd radii(system.dofs());
  for (int i = 0; i < system.dofs(); ++i) {
    const auto& name = system.names()[i];
    const auto starts = [&](const char* body) { return name.rfind(body, 0) == 0; };
    if (const auto end = end_of_rotor(stage, name))
      radii[i] = end->radius;
    else if (name.ends_with("_x"))
      radii[i] = 1;
    else if (starts("planet"))
      radii[i] = stage.planet_base_radius();
    else if (starts("crank"))
      radii[i] = stage.eccentricity;
    else if (starts("arc") || starts("output"))
      radii[i] = stage.crank_circle_radius();
    else
      radii[i] = stage.sun_base_radius();
  }
  return radii;
}

Eigen::VectorXd rigid_motion(const TwoKVStage& stage, const LumpedSystem& system) {
  Eigen::VectorXd motion = dof_radii(stage, system);
  for (int i = 0; i < system.dofs(); ++i) {
    const auto& name = system.names()[i];
    const auto starts = [&](const char* body) { return name.rfind(body, 0) == 0; };
    if (const auto end = end_of_rotor(stage, name))
      motion[i] *= end->name == "input" ? stage.ratio() : 1;
    else if (name.ends_with("_x"))
      motion[i] = starts("planet") ? stage.crank_circle_radius() : -stage.eccentricity * stage.arc_teeth;
    else if (starts("planet") || starts("crank"))
      motion[i] *= -stage.arc_teeth;
    else if (starts("input") || starts("sun"))
      motion[i] *= stage.ratio();
  }
  return motion;
}

}  // namespace annulus::dynamics
