#include "fem/problem/problem_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"

namespace annulus::fem {

namespace {

void check_gauges(const LoadedMeshProblem& problem, Fidelity fidelity) {
  if (problem.gauges.empty()) return;
  if (is_resolved(fidelity) || fidelity == Fidelity::closed_form)
    throw InputError(
        fmt::format("strain gauges need a whole body of finite elements: use model = \"plane\" or "
                    "\"solid\", not \"{}\"",
                    fidelity_name(fidelity)));
  for (const auto& gauge : problem.gauges) {
    if (!(gauge.length > 0))
      throw InputError(fmt::format("strain gauge '{}' is {:.4g} mm long and needs a positive length", gauge.name,
                                   1e3 * gauge.length));
    if (!is_solid(fidelity) && gauge.direction == StrainGauge::Direction::axial)
      throw InputError(
          fmt::format("strain gauge '{}' measures along the axis, where a plane model has no strain: use "
                      "model = \"solid\"",
                      gauge.name));
  }
}

void check_rollers(const LoadedMeshProblem& problem, Fidelity fidelity) {
  if (!problem.planet_rollers) return;
  const auto& rollers = *problem.planet_rollers;
  if (is_resolved(fidelity) || fidelity == Fidelity::closed_form)
    throw InputError(
        fmt::format("a planet on rollers needs a whole body of finite elements: use model = \"plane\" or \"solid\", "
                    "not \"{}\"",
                    fidelity_name(fidelity)));
  if (problem.pair.pinion().helix_angle() != 0)
    throw InputError(fmt::format("a planet on rollers needs spur teeth, not helical ones of {:.4g} degrees",
                                 problem.pair.pinion().helix_angle() * 180 / M_PI));
  if (!(rollers.stiffness > 0) || !std::isfinite(rollers.stiffness) || !(rollers.play >= 0))
    throw InputError(
        fmt::format("rollers of {:.4g} N/m with {:.4g} m of play: the stiffness has to be positive and "
                    "finite, the play not negative",
                    rollers.stiffness, rollers.play));
  if (rollers.partner.pinion().teeth() != problem.pair.pinion().teeth() ||
      rollers.partner.internal() == problem.pair.internal())
    throw InputError(
        fmt::format("the other mesh of a planet with {} teeth on rollers has a planet with {} teeth, and has to be {}",
                    problem.pair.pinion().teeth(), rollers.partner.pinion().teeth(),
                    problem.pair.internal() ? "external" : "internal"));
}

}  // namespace

void check_problem(const LoadedMeshProblem& problem, Fidelity fidelity) {
  if (problem.loads.empty() || problem.phases < 2)
    throw InputError(fmt::format("a loaded mesh needs a load and two phases, and has {} and {}", problem.loads.size(),
                                 problem.phases));
  for (std::size_t i = 0; i < problem.loads.size(); ++i)
    if (!(problem.loads[i] > (i > 0 ? problem.loads[i - 1] : 0.0)))
      throw InputError(
          fmt::format("the loads of a stiffness table have to be positive and strictly increasing: load {} "
                      "is {:.6g} N after {:.6g} N",
                      i + 1, problem.loads[i], i > 0 ? problem.loads[i - 1] : 0.0));
  if (!problem.pair.internal() && !held_outside(problem.structure))
    throw InputError(fmt::format("a ring structure ({}) belongs to the ring mesh, and the pair is external",
                                 problem.structure.words().description));
  check_gauges(problem, fidelity);
  check_rollers(problem, fidelity);
  // Meshes of the resolved model are made for contacts of flanks without them.
  if (fidelity == Fidelity::closed_form || is_resolved(fidelity))
    for (const auto* gear : {&problem.pair.pinion(), &problem.pair.wheel()})
      if (geometry::measured(gear->parameters()))
        throw InputError(
            fmt::format("the model {} does not cover measured flanks: use model = \"automatic\", \"plane\" or "
                        "\"solid\"",
                        fidelity_name(fidelity)));
  if (is_solid(fidelity)) return;
  for (const auto* gear : {&problem.pair.pinion(), &problem.pair.wheel()}) {
    if (geometry::modified_along_face(gear->parameters()))
      throw InputError(
          fmt::format("lead modifications (crowning {:.4g} um, slope {:.4g} um, or measured flanks) need a load "
                      "distribution over the face width: use model = \"solid\"",
                      1e6 * gear->parameters().lead_crowning, 1e6 * gear->parameters().lead_slope));
    if (gear->helix_angle() != 0)
      throw InputError(fmt::format("helical gears (here of {:.4g} degrees) need solid bodies: use model = \"solid\"",
                                   gear->helix_angle() * 180 / M_PI));
  }
  if (problem.misalignment != 0)
    throw InputError(
        fmt::format("a misalignment of {:.4g} um needs a load distribution over the face width: use model "
                    "= \"solid\"",
                    1e6 * problem.misalignment));
}

double plane_strain_error(const LoadedMeshProblem& problem) {
  const double nu = problem.materials.larger_poisson_ratio();
  const double width = problem.face_width / problem.pair.pinion().parameters().module;
  return 0.65 * nu * nu / (1 - nu * nu) / (1 + width / 10);
}

double plane_error(const LoadedMeshProblem& problem) {
  // Solid sun meshes 10 modules wide are stiffer by 2.9, 4.5 and 7.5 % with a pinion that is wider by 0.5, 1 and 4
  // modules on either side: what is farther away than some modules supports no more.
  constexpr double most = 0.45;  // modules of width, on one side
  const double module = problem.pair.pinion().parameters().module;
  double supported = 0;
  for (const auto* overhang : {&problem.pinion_overhang, &problem.wheel_overhang})
    for (const double side : {overhang->below, overhang->above})
      supported += most * module * (1 - std::exp(-side / module));
  return plane_strain_error(problem) + supported / problem.face_width;
}

double chamfer_error(const LoadedMeshProblem& problem) {
  double error = 0;
  for (const auto* gear : {&problem.pair.pinion(), &problem.pair.wheel()}) {
    const double modules = gear->parameters().tip_chamfer / gear->parameters().module;
    error += modules < 0.1 ? 0.08 * modules : 0.008 + 0.02 * (modules - 0.1);
  }
  return error;
}

void check_deflection(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                      const LoadedPosition& position) {
  const double deflection = position.entry.lte - position.entry.unloaded_te;
  const double modules = deflection / problem.pair.pinion().parameters().module;
  if (modules <= settings.largest_deflection) return;
  throw InputError(
      fmt::format("the {} mesh deflects by {:.4g} mm = {:.3g} modules under {:.4g} N; the model is for small "
                  "displacements and strains, up to {} modules. Reduce the load, or make teeth, rim, supports or "
                  "material stiffer and their clearances smaller",
                  problem.pair.internal() ? "ring" : "external", 1e3 * deflection, modules, position.load,
                  settings.largest_deflection));
}

void check_rise(const LoadedMeshProblem& problem, const std::vector<LoadedPosition>& positions) {
  constexpr double by_elements = 2e-3;  // of the deflection
  const std::size_t loads = problem.loads.size();
  for (std::size_t first = 0; first < positions.size(); first += loads) {
    const LoadedPosition* lighter = nullptr;
    for (std::size_t i = first; i < first + loads; ++i) {
      const auto& position = positions[i];
      if (position.entry.stiffness_secant == 0) continue;  // not solved
      if (lighter != nullptr &&
          position.entry.lte <= lighter->entry.lte - by_elements * (position.entry.lte - position.entry.unloaded_te))
        require(false, fmt::format("the transmission error does not rise with the load: {:.6g} um under {:.6g} N, "
                                   "{:.6g} um under {:.6g} N (mesh phase {:.4f}, mesh cycle {})",
                                   1e6 * lighter->entry.lte, lighter->load, 1e6 * position.entry.lte, position.load,
                                   position.mesh_phase, position.ring_tooth));
      lighter = &position;
    }
  }
}

double turn_on_supports(const LoadedMeshProblem& problem, double force) {
  const double outside = problem.wheel_support_radius, lever = problem.pair.wheel().base_radius();
  const SupportSites supports = support_sites(problem);
  double stiffness = 0, play = 0;
  // Of the two flanks of a spline tooth one resists.
  for (const auto& site : supports.sites)
    for (const auto& direction : site.directions)
      if (direction.counter_clockwise > 0) {
        stiffness += direction.total_stiffness() * std::pow(direction.counter_clockwise * outside, 2);
        play = direction.clearance / direction.counter_clockwise / outside;
      }
  // On a single pin the ring rotates until it leans on its housing, which shifts its centre and rotates it, at worst
  // both equally.
  if (supports.pins == 1) play = supports.sites.back().directions.front().clearance * (1 / outside + 1 / lever);
  return play * lever + force * lever * lever / stiffness;
}

}  // namespace annulus::fem
