#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "fem/levels/level.h"
#include "fem/levels/mesh_bodies.h"
#include "fem/recovery/field_recovery.h"

namespace annulus::fem {
namespace {

/// A line of the solve as a curve of the real body, at the axial station with the largest stress. The ring mesh is
/// solved in a mirror image.
StressCurve make_curve(const char* name, std::ptrdiff_t position, const StressRecovery::Line& line, bool mirrored) {
  StressCurve curve;
  curve.name = name;
  curve.position = static_cast<std::size_t>(position);
  Eigen::Index point = 0, station = 0;
  line.von_mises.maxCoeff(&point, &station);
  for (std::size_t i = 0; i < line.abscissa.size(); ++i) {
    curve.abscissa.push_back(line.abscissa[i]);
    curve.tangential.push_back(line.tangential(static_cast<Eigen::Index>(i), station));
    curve.von_mises.push_back(line.von_mises(static_cast<Eigen::Index>(i), station));
  }
  if (!mirrored) return curve;
  const bool along_arc = curve.name != "wheel rim";
  const double length = curve.abscissa.back();
  for (auto& a : curve.abscissa) a = along_arc ? length - a : -a;
  for (auto* values : {&curve.abscissa, &curve.tangential, &curve.von_mises})
    std::reverse(values->begin(), values->end());
  return curve;
}

/// The stress curves at the positions with the largest stresses under the middle load.
std::vector<StressCurve> worst_curves(const LoadedMeshProblem& problem, const MeshBodies& bodies,
                                      const ContactSystem& system, const std::vector<LoadedPosition>& positions) {
  std::vector<StressCurve> result;
  const std::size_t loads = problem.loads.size();
  const auto add = [&](const char* name, double BodyStress::*value, bool wheel,
                       StressRecovery::Line StressRecovery::Result::*line) {
    const auto stress = [&](std::size_t i) {
      return (wheel ? *positions[i].wheel_stress : *positions[i].planet_stress).*value;
    };
    std::size_t worst = loads / 2;
    for (std::size_t i = worst; i < positions.size(); i += loads)
      if (stress(i) > stress(worst)) worst = i;
    if (stress(worst) == 0) return;  // no such line
    ContactSystem::WarmStart warm;
    ContactSystem::PairsCache cache;
    ContactForces forces;
    (void)system.solve(positions[worst].ring_tooth, positions[worst].mesh_phase, positions[worst].load, cache, warm,
                       &forces);
    const auto all = wheel ? bodies.wheel_stress->stresses(forces.wheel, forces.supports)
                           : bodies.planet_stress->stresses(forces.planet, {});
    result.push_back(make_curve(name, static_cast<std::ptrdiff_t>(worst), all.*line, problem.pair.internal()));
  };
  add("planet root", &BodyStress::root_von_mises, false, &StressRecovery::Result::root);
  add("wheel root", &BodyStress::root_von_mises, true, &StressRecovery::Result::root);
  add("wheel rim", &BodyStress::rim_von_mises, true, &StressRecovery::Result::rim);
  return result;
}

/// Displacement and stress of both bodies where the wheel's root, or without one the planet's, is stressed most.
std::vector<BodyField> worst_fields(const LoadedMeshProblem& problem, const MeshBodies& bodies,
                                    const ContactSystem& system, const std::vector<LoadedPosition>& positions) {
  const std::size_t loads = problem.loads.size();
  std::size_t worst = loads / 2;
  for (std::size_t i = worst; i < positions.size(); i += loads)
    if (positions[i].wheel_stress->root_von_mises > positions[worst].wheel_stress->root_von_mises) worst = i;
  ContactSystem::WarmStart warm;
  ContactSystem::PairsCache cache;
  ContactForces forces;
  (void)system.solve(positions[worst].ring_tooth, positions[worst].mesh_phase, positions[worst].load, cache, warm,
                     &forces);
  std::vector<BodyField> fields;
  const auto add = [&](const char* name, const BodySource& source, const CondensedBody& body,
                       const std::vector<ToothForces>& teeth, const SupportRow* supports) {
    const FieldRecovery recovery(body.body(), source, problem.material, problem.face_width, supports);
    fields.push_back(recovery.field(teeth, forces, problem.pair.internal()));
    fields.back().body = name;
    fields.back().position = worst;
  };
  add("planet", bodies.planet_source, *bodies.planet, forces.planet, nullptr);
  add("wheel", bodies.wheel_source, *bodies.wheel, forces.wheel, bodies.supports.get());
  return fields;
}

/// What the discretised pressure leaves of the stiffness at the middle load: against twice as many elements, at some
/// positions of the first cycle. Halving constant pieces leaves a quarter of their error.
double contact_error(const LoadedMeshProblem& problem, const FlankContact& flanks, const MeshBodies& bodies,
                     ContactOptions options, const std::vector<LoadedPosition>& positions) {
  constexpr int places = 4;
  options.elements *= 2;
  const ContactSystem finer(flanks, *bodies.planet, *bodies.wheel, bodies.supports.get(), problem.material,
                            bodies.slice_edges, options);
  const std::size_t loads = problem.loads.size();
  double largest = 0;
  for (int i = 0; i < std::min(places, problem.phases); ++i) {
    const int phase = i * problem.phases / places, compared = phase - phase % compared_stride(problem);
    const auto& position = positions[static_cast<std::size_t>(compared) * loads + loads / 2];
    ContactSystem::PairsCache cache;
    ContactSystem::WarmStart warm;
    const auto fine = finer.solve(position.ring_tooth, position.mesh_phase, position.load, cache, warm, nullptr);
    largest = std::max(largest, std::abs(position.entry.stiffness_secant / fine.entry.stiffness_secant - 1));
  }
  return largest * 4 / 3;
}

}  // namespace

SolvedLevel solve_condensed_level(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                  const FlankContact& flanks, int level, const AcceptLevel& accept,
                                  const ProgressFunction& progress) {
  MeshBodies bodies = build_bodies(problem, flanks, settings, level);
  const Stopwatch watch;
  ContactOptions options;
  options.elements = pressure_elements(problem, settings, level);
  options.misalignment = problem.misalignment;
  options.half_face = bodies.face.half;
  const ContactSystem system(flanks, *bodies.planet, *bodies.wheel, bodies.supports.get(), problem.material,
                             bodies.slice_edges, options);
  const auto solve = [&](int cycle, int phase, int load, ContactSystem::PairsCache& cache,
                         ContactSystem::WarmStart& warm) {
    ContactForces forces;
    const bool stresses = accept && load == static_cast<int>(problem.loads.size() / 2);
    LoadedPosition position = system.solve(cycle, static_cast<double>(phase) / problem.phases, problem.loads[load],
                                           cache, warm, stresses ? &forces : nullptr);
    if (!stresses) return position;
    position.planet_stress = bodies.planet_stress->stresses(forces.planet, {}).largest;
    position.wheel_stress = bodies.wheel_stress->stresses(forces.wheel, forces.supports).largest;
    return position;
  };
  SolvedLevel result;
  const bool one_cycle = problem.structure.repeating_teeth(problem.pair.wheel().teeth()) == 1;
  const double compared = accept ? compared_share(problem) : 1;
  solve_positions(problem, settings, false, one_cycle, solve, part_of(progress, 0, compared), result.positions);
  if (accept) result.contact_error = contact_error(problem, flanks, bodies, options, result.positions);
  if (accept && accept(result)) {
    solve_positions(problem, settings, true, one_cycle, solve, part_of(progress, compared, 1), result.positions);
    result.stress_curves = worst_curves(problem, bodies, system, result.positions);
    if (settings.want_fields) result.fields = worst_fields(problem, bodies, system, result.positions);
  }
  result.planet_sector = std::move(bodies.planet_sector);
  result.wheel_sector = std::move(bodies.wheel_sector);
  result.half_face = bodies.face.half;
  result.unknowns = bodies.unknowns;
  if (bodies.supports) {
    const auto& sites = bodies.supports->plan().sites();
    result.pin_stiffness = sites.sites.front().directions.front().total_stiffness();
    // The frame of the solve is the mirror image of the real ring.
    for (int pin = 0; pin < sites.pins; ++pin) result.pin_angles.push_back(-sites.sites[pin].angle);
  }
  result.slice_edges = result.half_face ? mirrored_edges(bodies.slice_edges) : bodies.slice_edges;
  result.mesh_seconds = bodies.mesh_seconds;
  result.condense_seconds = bodies.condense_seconds;
  result.condensed_teeth = bodies.condensed_teeth;
  result.reused_teeth = bodies.reused_teeth;
  result.contact_seconds = watch.seconds();
  return result;
}

}  // namespace annulus::fem
