#include "dynamics/system/drive_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/errors.h"
#include "core/whole_ratio.h"
#include "dynamics/system/input_checks.h"
#include "dynamics/system/periods.h"
#include "dynamics/system/support.h"

namespace annulus::dynamics {

namespace {

std::string dof_of(const std::string& body) { return body + "_u"; }
std::string element_of(const std::string& rotor) { return rotor + "_shaft"; }

/// nullptr: there is none.
template <class Named>
const Named* find_named(const std::vector<Named>& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
  return found == list.end() ? nullptr : &*found;
}

/// planet3 -> planet
std::string without_number(std::string name) {
  while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.back())) != 0) name.pop_back();
  return name;
}

std::string fault_of_name(const std::vector<Rotor>& rotors, std::size_t rotor, const std::vector<ShaftEnd>& ends) {
  const auto& name = rotors[rotor].name;
  if (name.empty()) return "must not be empty";
  if (find_named(ends, without_number(name))) return fmt::format("must not be that of a body: '{}'", name);
  for (std::size_t i = 0; i < rotor; ++i)
    if (rotors[i].name == name) return fmt::format("'{}' is used for two rotors", name);
  return {};
}

std::string fault_of_place(const std::vector<Rotor>& rotors, std::size_t rotor, const std::vector<ShaftEnd>& ends) {
  const auto& on = rotors[rotor].on;
  const auto* body = find_named(ends, on);
  if (!body && !find_named(rotors, on)) {
    std::vector<std::string> names;
    for (const auto& end : ends)
      if (end.refusal.empty()) names.push_back(end.name);
    return fmt::format("'{}' is neither another rotor nor one of {}", on, fmt::join(names, ", "));
  }
  if (body && !body->refusal.empty()) return fmt::format("no shaft can lead to '{}': {}", on, body->refusal);
  for (std::size_t i = 0; i < rotor; ++i)
    if (rotors[i].on == on)
      return fmt::format("the shaft of rotor '{0}' leads to '{1}' already; let this one lead to '{0}'", rotors[i].name,
                         on);
  for (const auto& end : ends)
    for (const auto i : rotors_of(rotors, end.name))
      if (i == rotor) return {};
  return fmt::format("'{}' leads back to this rotor, and to no body", on);
}

}  // namespace

RotorFault rotor_fault(const std::vector<Rotor>& rotors, std::size_t rotor, const std::vector<ShaftEnd>& ends) {
  return {fault_of_name(rotors, rotor, ends), fault_of_place(rotors, rotor, ends)};
}

void check_rotors(const std::vector<Rotor>& rotors, const std::vector<ShaftEnd>& ends) {
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    const auto& rotor = rotors[i];
    const auto fault = rotor_fault(rotors, i, ends);
    if (!fault.name.empty()) throw InputError(fmt::format("rotor '{}': its name {}", rotor.name, fault.name));
    if (!fault.on.empty()) throw InputError(fmt::format("rotor '{}': {}", rotor.name, fault.on));
    const auto of = [&](const char* what) { return fmt::format("{} of rotor '{}'", what, rotor.name); };
    check_positive(rotor.inertia, of("inertia"));
    check_positive(rotor.shaft_stiffness, of("shaft stiffness"));
    check_not_negative(rotor.shaft_damping_ratio, of("shaft damping ratio"));
    check_not_negative(rotor.half_backlash, of("half backlash"));
    for (const auto& ripple : rotor.ripples) {
      check_positive(ripple.order, of("order of a torque"));
      if (!std::isfinite(ripple.amplitude) || !std::isfinite(ripple.phase))
        throw InputError(fmt::format("rotor '{}': a torque of {} N m with phase {} rad must be finite", rotor.name,
                                     ripple.amplitude, ripple.phase));
    }
  }
}

void check_ripples(const std::vector<Rotor>& rotors, const std::vector<ShaftEnd>& ends) {
  for (const auto& rotor : rotors) {
    if (rotor.ripples.empty()) continue;
    const auto& end = end_of(rotor, rotors, ends);
    if (end.speed == 0)
      throw InputError(fmt::format("rotor '{}': a torque of order {} needs a rotor that turns, and '{}' does not",
                                   rotor.name, rotor.ripples.front().order, end.name));
  }
}

int ripple_period(const std::vector<Rotor>& rotors, const std::vector<ShaftEnd>& ends, double frequency) {
  int period = 1;
  for (const auto& rotor : rotors)
    for (const auto& ripple : rotor.ripples) {
      const double own = ripple.order * std::abs(end_of(rotor, rotors, ends).speed) / (2 * std::numbers::pi);
      if (own == 0) continue;
      const auto ratio = whole_ratio(frequency / own);
      period = ratio ? common_period(period, static_cast<int>(ratio->first)) : never_repeats;
    }
  return period;
}

std::vector<std::size_t> rotors_of(const std::vector<Rotor>& rotors, const std::string& body) {
  std::vector<std::size_t> chain;
  std::string last = body;
  for (;;) {
    const auto next = std::find_if(rotors.begin(), rotors.end(), [&](const auto& rotor) { return rotor.on == last; });
    if (next == rotors.end() || chain.size() == rotors.size()) return chain;
    chain.push_back(static_cast<std::size_t>(next - rotors.begin()));
    last = next->name;
  }
}

const ShaftEnd& end_of(const Rotor& rotor, const std::vector<Rotor>& rotors, const std::vector<ShaftEnd>& ends) {
  for (const auto& end : ends)
    for (const auto i : rotors_of(rotors, end.name))
      if (rotors[i].name == rotor.name) return end;
  throw InternalError(fmt::format("internal error: rotor '{}' belongs to no body", rotor.name));
}

Eigen::VectorXd turning_as_one(const LumpedSystem& system, const std::vector<Rotor>& rotors, const std::string& body) {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(system.dofs());
  motion[system.find(dof_of(body))] = 1;
  for (const auto i : rotors_of(rotors, body)) motion[system.find(dof_of(rotors[i].name))] = 1;
  return motion;
}

Turning turning_of(const std::vector<ShaftEnd>& ends) {
  for (const auto& end : ends)
    if (end.speed != 0 && end.radius > 0) return {dof_of(end.name), end.radius * end.speed};
  return {};
}

LumpedSystem with_rotors(const LumpedSystem& system, const std::vector<Rotor>& rotors,
                         const std::vector<ShaftEnd>& ends) {
  if (rotors.empty()) return system;
  check_rotors(rotors, ends);
  for (const auto& rotor : rotors)
    if (system.find(dof_of(rotor.name)) >= 0 || find_named(system.meshes(), element_of(rotor.name)))
      throw InputError(
          fmt::format("rotor '{}': '{}' or '{}' is another part of the system already; give it another name",
                      rotor.name, dof_of(rotor.name), element_of(rotor.name)));
  LumpedSystemBuilder builder;
  builder.add(system);
  for (const auto& end : ends) {
    const auto chain = rotors_of(rotors, end.name);
    if (chain.empty()) continue;
    const int body = system.find(dof_of(end.name));
    const double load = end.load, square = end.radius * end.radius;
    double mass_before = system.mass()(body, body);
    const LinearForm first{{body, 1.0}};
    LinearForm before = first;
    for (const auto i : chain) {
      const auto& rotor = rotors[i];
      const LinearForm u = builder.add_dof(dof_of(rotor.name));
      const double mass = rotor.inertia / square, stiffness = rotor.shaft_stiffness / square;
      builder.add_mass(u, mass);
      const double sense = load < 0 ? -1 : 1;
      for (const auto& ripple : rotor.ripples) {
        if (end.speed == 0) break;
        const double force = sense * ripple.amplitude / end.radius;
        builder.add_harmonic_load(u, ripple.order * std::abs(end.speed), force * std::cos(ripple.phase),
                                  -force * std::sin(ripple.phase));
      }
      MeshElement shaft;
      shaft.name = element_of(rotor.name);
      shaft.shaft = true;
      shaft.b = sense * u + (-sense) * before;
      shaft.excitation = ConstantStiffness{stiffness};
      shaft.damping = critical_share(rotor.shaft_damping_ratio, stiffness, 1 / (1 / mass + 1 / mass_before));
      if (rotor.half_backlash > 0) shaft.half_backlash = end.radius * rotor.half_backlash;
      builder.add_mesh(std::move(shaft));
      before = u;
      mass_before = mass;
    }
    builder.add_load(first, -load, LoadCause::torque);
    builder.add_load(before, load, LoadCause::torque);
  }
  return builder.build();
}

}  // namespace annulus::dynamics
