#include "dynamics/systems/train/train.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/errors.h"
#include "core/whole_ratio.h"
#include "dynamics/figures/common_figures.h"
#include "dynamics/friction/balanced_friction.h"
#include "dynamics/system/input_checks.h"
#include "dynamics/system/periods.h"
#include "dynamics/system/support.h"

namespace annulus::dynamics {

namespace {

const TrainPart* find_part(const Train& train, const std::string& name) {
  const auto found =
      std::find_if(train.parts.begin(), train.parts.end(), [&](const auto& part) { return part.name == name; });
  return found == train.parts.end() ? nullptr : &*found;
}

std::string full_name(const TrainShaft::End& end) { return end.part + "." + end.body; }

/// A body at the end of a shaft.
struct Place {
  const TrainPart* part;
  const ShaftEnd* end;
  [[nodiscard]] int dof() const { return part->lumped.system.find(end->name + "_u"); }
  [[nodiscard]] double load() const { return end->load; }
  [[nodiscard]] double torque() const { return load() * end->radius; }
  [[nodiscard]] double mass() const { return part->lumped.system.mass()(dof(), dof()); }
};

Place place_of(const Train& train, const TrainShaft& shaft, const TrainShaft::End& end) {
  const auto* part = find_part(train, end.part);
  if (part == nullptr) throw InputError(fmt::format("shaft '{}': there is no part '{}'", shaft.name, end.part));
  for (const auto& body : part->ends) {
    if (body.name != end.body) continue;
    if (!body.refusal.empty())
      throw InputError(
          fmt::format("shaft '{}': no shaft can lead to '{}': {}", shaft.name, full_name(end), body.refusal));
    return {part, &body};
  }
  throw InputError(fmt::format("shaft '{}': part '{}' has no body '{}'", shaft.name, end.part, end.body));
}

void check_shaft(const Train& train, const TrainShaft& shaft) {
  check_positive(shaft.stiffness, fmt::format("stiffness of shaft '{}'", shaft.name));
  check_not_negative(shaft.damping_ratio, fmt::format("damping ratio of shaft '{}'", shaft.name));
  check_not_negative(shaft.half_backlash, fmt::format("half backlash of shaft '{}'", shaft.name));
  const auto from = place_of(train, shaft, shaft.from), to = place_of(train, shaft, shaft.to);
  if (from.part == to.part)
    throw InputError(fmt::format("shaft '{}' has both ends in part '{}'", shaft.name, from.part->name));
  constexpr double same = 1e-6;
  const double a = std::abs(from.torque()), b = std::abs(to.torque());
  if (std::abs(a - b) > same * std::max(a, b))
    throw InputError(fmt::format("shaft '{}': the torque of '{}' is {:.7g} N m, that of '{}' {:.7g} N m", shaft.name,
                                 full_name(shaft.from), a, full_name(shaft.to), b));
}

/// Shafts connect all parts with the first one, each in one way: no load would reach parts in a ring of shafts.
void check_connections(const Train& train) {
  std::map<std::string, std::string> lead;  // of the parts that are connected with each other
  for (const auto& part : train.parts) lead[part.name] = part.name;
  for (const auto& shaft : train.shafts) {
    const auto from = lead[shaft.from.part], to = lead[shaft.to.part];
    if (from == to)
      throw InputError(
          fmt::format("shaft '{}': other shafts connect '{}' with '{}' already; a torque that is locked in "
                      "between shafts is not modelled",
                      shaft.name, shaft.from.part, shaft.to.part));
    for (auto& [part, own] : lead)
      if (own == to) own = from;
  }
  const auto& first = train.parts.front().name;
  for (const auto& part : train.parts)
    if (lead[part.name] != lead[first])
      throw InputError(fmt::format("no shaft connects part '{}' with '{}'", part.name, first));
}

void add_shaft(LumpedSystemBuilder& builder, const std::vector<int>& first_dof, const Train& train,
               const TrainShaft& shaft) {
  const auto from = place_of(train, shaft, shaft.from), to = place_of(train, shaft, shaft.to);
  MeshElement element;
  element.name = shaft.name;
  element.shaft = true;
  double inverse = 0;
  for (const auto& place : {from, to}) {
    const auto part = static_cast<std::size_t>(place.part - train.parts.data());
    const LinearForm u{{first_dof[part] + place.dof(), 1.0}};
    const double sense = place.load() < 0 ? -1 : 1, r = from.end->radius / place.end->radius;
    element.b = element.b + (-sense * r) * u;  // lengths at the radius of the first body
    inverse += r * r / place.mass();
    builder.add_load(u, -place.load(), LoadCause::torque);
  }
  const double stiffness = shaft.stiffness / std::pow(from.end->radius, 2);
  element.excitation = ConstantStiffness{stiffness};
  element.damping = critical_share(shaft.damping_ratio, stiffness, 1 / inverse);
  if (shaft.half_backlash > 0) element.half_backlash = from.end->radius * shaft.half_backlash;
  builder.add_mesh(std::move(element));
}

double fastest_mesh(const Train& train) {
  double frequency = 0;
  for (const auto& part : train.parts) frequency = std::max(frequency, part.lumped.problem.mesh_frequency);
  return frequency;
}

/// Cycles of the fastest mesh.
int period_of(const Train& train) {
  const double base = fastest_mesh(train);
  int period = ripple_period(train.rotors, train.shaft_ends(), base);
  for (const auto& part : train.parts) {
    const auto& problem = part.lumped.problem;
    if (problem.period_in_cycles >= never_repeats) return never_repeats;
    const auto ratio = whole_ratio(problem.period_in_cycles * base / problem.mesh_frequency);
    period = ratio ? common_period(period, static_cast<int>(ratio->first)) : never_repeats;
  }
  constexpr int most = 1000000;
  return period > most ? never_repeats : period;
}

}  // namespace

std::vector<ShaftEnd> Train::shaft_ends() const {
  std::vector<ShaftEnd> ends;
  for (const auto& part : parts)
    for (auto end : part.ends) {
      for (const auto& shaft : shafts)
        for (const auto* place : {&shaft.from, &shaft.to})
          if (place->part == part.name && place->body == end.name)
            end.refusal = "shaft '" + shaft.name + "' leads to it";
      end.name = part.name + "." + end.name;
      ends.push_back(std::move(end));
    }
  return ends;
}

void Train::check() const {
  if (parts.empty()) throw InputError("a train needs at least one part");
  std::set<std::string> names;
  for (const auto& part : parts)
    if (part.name.empty() || !names.insert(part.name).second)
      throw InputError(fmt::format("part '{}': its name has to differ from those of the other parts", part.name));
  std::set<std::string> elements, taken;
  for (const auto& shaft : shafts) {
    check_shaft(*this, shaft);
    if (!elements.insert(shaft.name).second) throw InputError(fmt::format("two shafts have the name '{}'", shaft.name));
    for (const auto* end : {&shaft.from, &shaft.to})
      if (!taken.insert(full_name(*end)).second)
        throw InputError(fmt::format("shaft '{}': another shaft leads to '{}' already", shaft.name, full_name(*end)));
  }
  check_connections(*this);
  for (const auto& rotor : rotors)
    if (elements.count(rotor.name) > 0)
      throw InputError(fmt::format("a shaft and a rotor have the name '{}'", rotor.name));
  check_rotors(rotors, shaft_ends());
}

LumpedSystem assemble(const Train& train) {
  train.check();
  LumpedSystemBuilder builder;
  std::vector<int> first_dof;
  int dofs = 0;
  for (const auto& part : train.parts) {
    builder.add(part.lumped.system, part.name + ".");
    first_dof.push_back(dofs);
    dofs += part.lumped.system.dofs();
  }
  for (const auto& shaft : train.shafts) add_shaft(builder, first_dof, train, shaft);
  const auto ends = train.shaft_ends();
  return with_balanced_friction(with_rotors(builder.build(), train.rotors, ends), train.rotors, ends);
}

SteadyProblem steady_problem(const Train& train) {
  // The smallest force and the smallest deflection are resolved.
  double force = std::numeric_limits<double>::infinity(), deflection = force;
  for (const auto& part : train.parts) {
    const auto& problem = part.lumped.problem;
    force = std::min(force, problem.force_scale);
    deflection = std::min(deflection, problem.force_scale / problem.stiffness);
  }
  return {fastest_mesh(train), period_of(train), force, force / deflection};
}

LumpedCase lumped_case(const Train& train) {
  auto system = assemble(train);
  check_ripples(train.rotors, train.shaft_ends());
  return {std::move(system), steady_problem(train), turning_of(train.shaft_ends())};
}

TrainResponse simulate(const Train& train, const SimulationOptions& options) {
  const auto [system, problem, turning] = lumped_case(train);
  auto found = steady_response(system, problem, options);
  TrainResponse response;
  response.mesh_frequency = problem.mesh_frequency;
  Eigen::Index m = 0;
  for (const auto& part : train.parts)
    for (std::size_t i = 0; i < part.lumped.system.meshes().size(); ++i, ++m) {
      const auto& mesh = part.lumped.system.meshes()[i];
      if (!part.lumped.system.is_gear_mesh(static_cast<int>(i)) || mesh.frequency == 0) continue;
      const double frequency = std::abs(mesh.frequency);
      const auto result = branch_results(found, m, 1, 1, problem.mesh_frequency / frequency).front();
      response.meshes.push_back({part.name, system.meshes()[static_cast<std::size_t>(m)].name, frequency,
                                 result.mean_force, result.dynamic_factor, result.peak_factor, result.smallest_factor,
                                 result.contact_loss});
    }
  for (const auto& shaft : train.shafts) {
    const auto place = place_of(train, shaft, shaft.from);
    auto& result = response.shafts.emplace_back(
        shaft_result(system, shaft.name, {std::abs(place.load()), place.end->radius}, found));
    result.name = shaft.name;
    result.on = full_name(shaft.from) + " to " + full_name(shaft.to);
  }
  for (auto& shaft : shaft_results(system, train.rotors, train.shaft_ends(), found))
    response.shafts.push_back(std::move(shaft));
  static_cast<SteadyOutcome&>(response) = static_cast<const SteadyOutcome&>(found);
  if (options.keep_series) response.series = series_of(system, std::move(found.best));
  return response;
}

Modes modes(const Train& train) { return modes(assemble(train)); }

const std::vector<FigureSpec>& train_figures() {
  static const auto list = [] {
    std::vector<FigureSpec> specs;
    auto factors = force_factor_figures("", "the meshes", "");
    factors.resize(1);  // K_V alone: parts have nominal forces of their own
    factors.front().beside.clear();
    factors.front().ordering = true;
    specs.push_back(factors.front());
    specs.push_back(contact_loss_figure("contact_loss", "Time without contact", "worst mesh, %",
                                        "largest over the meshes of the fraction of the time in which no tooth "
                                        "touches"));
    specs.push_back(shaft_figure());
    specs.push_back(steady_figure());
    specs.push_back(motions_figure());
    const auto frequencies =
        frequency_specs(train_frequencies,
                        "undamped natural frequencies of the train above zero, rising, with the mean mesh stiffness");
    specs.insert(specs.end(), frequencies.begin(), frequencies.end());
    return specs;
  }();
  return list;
}

FigureSet figures(const TrainResponse& response) {
  FigureSet set;
  for (const auto& [key, value] :
       {std::pair{"dynamic_factor", &TrainMesh::dynamic_factor}, {"contact_loss", &TrainMesh::contact_loss}}) {
    Figure largest{not_known, not_known};
    for (const auto& mesh : response.meshes)
      if (!((mesh.*value).value <= largest.value)) largest = std::isnan((mesh.*value).value) ? largest : mesh.*value;
    set.set(key, largest);
  }
  add_shafts(set, response.shafts);
  set.set("steady", response.steady ? 1 : 0);
  set.set(motions_key, number_of(response.motions));
  return set;
}

}  // namespace annulus::dynamics
