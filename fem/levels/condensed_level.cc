#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "core/stopwatch.h"
#include "fem/levels/level.h"
#include "fem/levels/mesh_bodies.h"
#include "fem/recovery/field_recovery.h"

namespace annulus::fem {
namespace {

/// A line of the solve as a curve of the real body, at the axial station with the largest stress. The ring mesh is
/// solved in a mirror image.
StressCurve make_curve(geometry::GearRole body, StressCurve::Along along, std::size_t position,
                       const StressRecovery::Line& line, bool mirrored) {
  StressCurve curve{.body = body, .along = along, .position = position};
  Eigen::Index point = 0, station = 0;
  line.von_mises.maxCoeff(&point, &station);
  for (std::size_t i = 0; i < line.abscissa.size(); ++i) {
    curve.abscissa.push_back(line.abscissa[i]);
    curve.tangential.push_back(line.tangential(static_cast<Eigen::Index>(i), station));
    curve.von_mises.push_back(line.von_mises(static_cast<Eigen::Index>(i), station));
  }
  if (!mirrored) return curve;
  const double length = curve.abscissa.back();
  for (auto& a : curve.abscissa) a = along == StressCurve::Along::root ? length - a : -a;
  for (auto* values : {&curve.abscissa, &curve.tangential, &curve.von_mises})
    std::reverse(values->begin(), values->end());
  return curve;
}

/// The position with the largest value under the middle load.
template <class Value>
std::size_t worst_position(const std::vector<LoadedPosition>& positions, std::size_t loads, const Value& value) {
  std::size_t worst = loads / 2;
  for (std::size_t i = worst; i < positions.size(); i += loads)
    if (value(positions[i]) > value(positions[worst])) worst = i;
  return worst;
}

/// All forces of a position that has been solved.
ContactForces forces_at(const ContactSystem& system, const LoadedPosition& position) {
  ContactSystem::WarmStart warm;
  ContactSystem::PairsCache cache;
  ContactForces forces;
  (void)system.solve(position.ring_tooth, position.mesh_phase, position.load, cache, warm, &forces);
  return forces;
}

/// The stress curves at the positions with the largest stresses under the middle load.
std::vector<StressCurve> worst_curves(const LoadedMeshProblem& problem, const MeshBodies& bodies,
                                      const ContactSystem& system, const std::vector<LoadedPosition>& positions) {
  std::vector<StressCurve> result;
  using Along = StressCurve::Along;
  using Result = StressRecovery::Result;
  for (const auto body : {geometry::GearRole::pinion, geometry::GearRole::wheel}) {
    const bool wheel = body == geometry::GearRole::wheel;
    const auto found = wheel ? &LoadedPosition::wheel_stress : &LoadedPosition::pinion_stress;
    for (const auto& [along, value, line] : {std::tuple{Along::root, &BodyStress::root_von_mises, &Result::root},
                                             {Along::rim, &BodyStress::rim_von_mises, &Result::rim}}) {
      const auto stress = [found, of = value](const LoadedPosition& p) { return (*(p.*found)).*of; };
      const std::size_t worst = worst_position(positions, problem.loads.size(), stress);
      if (stress(positions[worst]) == 0) continue;  // no such line
      const auto forces = forces_at(system, positions[worst]);
      const auto all = wheel ? bodies.wheel_stress->stresses(forces.wheel, forces.supports)
                             : bodies.pinion_stress->stresses(forces.pinion, forces.rollers);
      result.push_back(make_curve(body, along, worst, all.*line, problem.pair.internal()));
    }
  }
  return result;
}

/// Where displacement and stress are wanted: where the wheel's root, or without one the pinion's, is stressed most, or
/// at some phases of the first mesh cycle under the middle load.
std::vector<std::size_t> wanted_positions(const LoadedMeshProblem& problem, Recovery recovery,
                                          const std::vector<LoadedPosition>& positions) {
  const auto loads = problem.loads.size();
  if (recovery == Recovery::stresses) return {};
  if (recovery == Recovery::fields)
    return {worst_position(positions, loads, [](const auto& p) { return p.wheel_stress->root_von_mises; })};
  constexpr int most = 16;
  const int stride = (problem.phases + most - 1) / most;
  std::vector<std::size_t> list;
  for (int phase = 0; phase < problem.phases; phase += stride)
    list.push_back(static_cast<std::size_t>(phase) * loads + loads / 2);
  return list;
}

std::vector<BodyField> fields_at(const std::vector<std::size_t>& wanted, const LoadedMeshProblem& problem,
                                 const MeshBodies& bodies, const ContactSystem& system,
                                 const std::vector<LoadedPosition>& positions) {
  if (wanted.empty()) return {};
  const FieldRecovery pinion(bodies.pinion->body(), bodies.pinion_source, problem.materials.pinion, problem.face_width,
                             bodies.rollers ? &bodies.rollers->row() : nullptr),
      wheel(bodies.wheel->body(), bodies.wheel_source, problem.materials.wheel, problem.face_width,
            bodies.supports.get());
  std::vector<BodyField> fields;
  for (const auto position : wanted) {
    const auto forces = forces_at(system, positions[position]);
    // Without its motion in the bearing, which would hide how it deforms.
    Eigen::VectorXd pinion_rigid = forces.pinion_rigid;
    if (pinion_rigid.size() > 0) pinion_rigid.head<2>().setZero();
    const bool mirrored = problem.pair.internal();
    fields.push_back(pinion.field(forces.pinion, forces.rollers, pinion_rigid, mirrored));
    fields.back().body = geometry::GearRole::pinion;
    fields.back().position = position;
    fields.push_back(wheel.field(forces.wheel, forces.supports, forces.rigid, mirrored));
    fields.back().body = geometry::GearRole::wheel;
    fields.back().position = position;
  }
  return fields;
}

/// A mesh that is some teeth further on a wheel that repeats strains a gauge as the mesh here strains one as many teeth
/// behind it.
std::vector<GaugeHistory> gauge_histories(const LoadedMeshProblem& problem, const FlankContact& flanks,
                                          const std::vector<LoadedPosition>& positions) {
  const auto& wheel = problem.pair.wheel();
  const int teeth = wheel.teeth(), repeating = problem.structure.repeating_teeth(teeth);
  const int step = wheel_tooth(flanks, 0, 1) - wheel_tooth(flanks, 0, 0);
  const double turn = (problem.pair.internal() ? -step : step) * wheel.pitch_angle();
  const std::size_t loads = problem.loads.size();
  std::vector<GaugeHistory> histories;
  for (std::size_t g = 0; g < problem.gauges.size(); ++g) {
    auto& history = histories.emplace_back(GaugeHistory{problem.gauges[g].name, {}, {}});
    for (int cycle = 0; cycle < teeth; ++cycle) {
      const int solved = cycle % repeating, further = cycle - solved;
      const int behind = (((-step * further) % teeth) + teeth) % teeth;
      for (int phase = 0; phase < problem.phases; ++phase) {
        const auto& position = positions[static_cast<std::size_t>(solved * problem.phases + phase) * loads + loads / 2];
        history.angle.push_back(position.ring_angle + further * turn);
        history.strain.push_back(position.gauge_strains.at(g)[behind]);
      }
    }
  }
  return histories;
}

/// What the discretised pressure leaves of the stiffness at the middle load: against twice as many elements, at some
/// positions of the first cycle. Halving constant pieces leaves a quarter of their error.
double contact_error(const LoadedMeshProblem& problem, const FlankContact& flanks, const MeshBodies& bodies,
                     ContactOptions options, const std::vector<LoadedPosition>& positions) {
  constexpr int places = 4;
  options.elements *= 2;
  const ContactSystem finer(flanks, *bodies.pinion, *bodies.wheel, bodies.supports.get(), problem.materials,
                            bodies.slice_edges, options, bodies.rollers.get());
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
  options.gaps = {problem.misalignment, problem.pinion_overhang.below, problem.wheel_overhang.below};
  options.half_face = bodies.face.half;
  const ContactSystem system(flanks, *bodies.pinion, *bodies.wheel, bodies.supports.get(), problem.materials,
                             bodies.slice_edges, options, bodies.rollers.get());
  const int middle = static_cast<int>(problem.loads.size() / 2);
  PositionSolver solver;
  solver.solve = [&](int cycle, int phase, int load, PositionTask& task, LoadedPosition& position) {
    ContactForces forces;
    position = system.solve(cycle, static_cast<double>(phase) / problem.phases, problem.loads[load], task.cache,
                            task.warm, &forces);
    if (load == middle)
      for (const auto& gauge : bodies.gauges)
        position.gauge_strains.push_back(gauge.strains(forces.wheel, forces.supports));
    task.without_stress.push_back({&position, load, std::move(forces)});
  };
  solver.find_stresses = [&](std::vector<PositionTask::Solved>& solved) {
    using Look = StressRecovery::Look;
    std::vector<StressRecovery::Forces> pinion, wheel;
    for (const auto& s : solved) {
      const auto look = s.load == middle ? Look::around : Look::near;
      pinion.push_back({&s.forces.pinion, &s.forces.rollers, look});
      wheel.push_back({&s.forces.wheel, &s.forces.supports, look});
    }
    const auto of_pinion = bodies.pinion_stress->largest(pinion), of_wheel = bodies.wheel_stress->largest(wheel);
    for (std::size_t i = 0; i < solved.size(); ++i) {
      solved[i].position->pinion_stress = of_pinion[i];
      solved[i].position->wheel_stress = of_wheel[i];
    }
  };
  SolvedLevel result;
  const auto tasks = problem.structure.repeating_teeth(problem.pair.wheel().teeth()) == 1 ? PositionTasks::by_load
                                                                                          : PositionTasks::by_phase;
  const double compared = accept ? compared_share(problem) : 1;
  solve_positions(problem, settings, PositionsOf::comparison, tasks, solver, part_of(progress, 0, compared),
                  result.positions);
  result.own.pinion_notch = bodies.pinion_notch.error;
  result.own.wheel_notch = bodies.wheel_notch.error;
  if (accept) result.own.contact = contact_error(problem, flanks, bodies, options, result.positions);
  if (accept && accept(result)) {
    solve_positions(problem, settings, PositionsOf::table, tasks, solver, part_of(progress, compared, 1),
                    result.positions);
    result.stress_curves = worst_curves(problem, bodies, system, result.positions);
    result.gauges = gauge_histories(problem, flanks, result.positions);
    result.fields = fields_at(wanted_positions(problem, settings.recovery, result.positions), problem, bodies, system,
                              result.positions);
  }
  result.pinion_sector = std::move(bodies.pinion_sector);
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
  static_cast<SolveCost&>(result) = static_cast<const SolveCost&>(bodies);
  result.contact_seconds = watch.seconds();
  return result;
}

}  // namespace annulus::fem
