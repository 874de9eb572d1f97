#include "fem/loaded_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "core/errors.h"
#include "fem/contact/contact_system.h"
#include "fem/mesh_bodies.h"

namespace annulus::fem {
namespace {

/// Teeth after which the structure of the wheel repeats.
int repeating_teeth(const LoadedMeshProblem& problem) {
  return repeating_teeth(problem.structure, problem.pair.wheel().teeth());
}

/// All positions of one level: [cycle][phase 0 ... phases][load]; the last phase of the last cycle is the closure,
/// inner ends of cycles are not solved twice.
class PositionRun {
 public:
  PositionRun(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, const FlankContact& flanks,
              const MeshBodies& bodies, int level)
      : problem_(problem),
        settings_(settings),
        bodies_(bodies),
        system_(flanks, *bodies.planet, *bodies.wheel, bodies.supports.get(), problem.material, bodies.slice_edges,
                options(problem, settings, level)),
        cycles_(repeating_teeth(problem)) {}

  [[nodiscard]] std::vector<LoadedPosition> solve(const std::function<void(double)>& progress) const {
    const int loads = static_cast<int>(problem_.loads.size()), phases = problem_.phases;
    std::vector<LoadedPosition> positions(static_cast<std::size_t>(cycles_ * phases + 1) * loads);
    // A ring that repeats with every tooth: one task per load, neighbouring phases warm-start each other. Otherwise one
    // task per load and phase, in which the pins move on from cycle to cycle. Never dependent on the number of threads.
    const bool one_cycle = cycles_ == 1;
    const int tasks = one_cycle ? loads : loads * (phases + 1);
    std::atomic<int> next{0}, done{0};
    std::mutex failure_lock;
    std::exception_ptr failure;
    const auto worker = [&] {
      for (int task = next++; task < tasks; task = next++) try {
          const int load = task % loads;
          const int first_phase = one_cycle ? 0 : task / loads, last_phase = one_cycle ? phases : first_phase;
          ContactSystem::WarmStart warm;
          ContactSystem::PairsCache pairs;
          for (int phase = first_phase; phase <= last_phase; ++phase)
            for (int cycle = phase == phases ? cycles_ - 1 : 0; cycle < cycles_; ++cycle) {
              ContactForces forces;
              auto& position = positions[static_cast<std::size_t>(cycle * phases + phase) * loads + load];
              position =
                  system_.solve(cycle, static_cast<double>(phase) / phases, problem_.loads[load], pairs, warm, &forces);
              position.planet_stress = bodies_.planet_stress->stresses(forces.planet, {}).largest;
              position.wheel_stress = bodies_.wheel_stress->stresses(forces.wheel, forces.supports).largest;
              if (load != loads / 2) position.pressure.clear();
            }
          ++done;
          if (progress) {
            const std::lock_guard lock(failure_lock);
            progress(static_cast<double>(done) / tasks);
          }
        } catch (...) {
          const std::lock_guard lock(failure_lock);
          if (!failure) failure = std::current_exception();
          next = tasks;
        }
    };
    std::vector<std::thread> pool;
    for (int t = 1; t < std::min(settings_.threads, tasks); ++t) pool.emplace_back(worker);
    worker();
    for (auto& t : pool) t.join();
    if (failure) std::rethrow_exception(failure);
    return positions;
  }

  /// The stress curves at the positions with the largest stresses.
  [[nodiscard]] std::vector<StressCurve> curves(const std::vector<LoadedPosition>& positions) const {
    std::vector<StressCurve> result;
    const auto add = [&](const char* name, double BodyStress::*value, bool wheel,
                         StressRecovery::Line StressRecovery::Result::*line) {
      const auto stress = [&](const LoadedPosition& p) { return (wheel ? *p.wheel_stress : *p.planet_stress).*value; };
      const auto worst = std::max_element(positions.begin(), positions.end(),
                                          [&](const auto& a, const auto& b) { return stress(a) < stress(b); });
      if (stress(*worst) == 0) return;  // no such line
      ContactSystem::WarmStart warm;
      ContactSystem::PairsCache pairs;
      ContactForces forces;
      (void)system_.solve(worst->ring_tooth, worst->mesh_phase, worst->load, pairs, warm, &forces);
      const auto all = wheel ? bodies_.wheel_stress->stresses(forces.wheel, forces.supports)
                             : bodies_.planet_stress->stresses(forces.planet, {});
      result.push_back(make_curve(name, worst - positions.begin(), all.*line));
    };
    add("planet root", &BodyStress::root_von_mises, false, &StressRecovery::Result::root);
    add("wheel root", &BodyStress::root_von_mises, true, &StressRecovery::Result::root);
    add("wheel rim", &BodyStress::rim_von_mises, true, &StressRecovery::Result::rim);
    return result;
  }

 private:
  static ContactOptions options(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level) {
    const double first = settings.rung == Rung::solid ? 6 : 10;  // in a solid, every slice has as many
    ContactOptions options;
    options.elements = static_cast<int>(std::lround(first * std::pow(1.25, level - 1)));
    options.misalignment = problem.misalignment;
    return options;
  }

  /// A line of the solve as a curve of the real body, at the axial station with the largest stress. The ring mesh is
  /// solved in a mirror image.
  [[nodiscard]] StressCurve make_curve(const char* name, std::ptrdiff_t position,
                                       const StressRecovery::Line& line) const {
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
    if (!problem_.pair.internal()) return curve;
    const bool along_arc = curve.name != "wheel rim";
    const double length = curve.abscissa.back();
    for (auto& a : curve.abscissa) a = along_arc ? length - a : -a;
    for (auto* values : {&curve.abscissa, &curve.tangential, &curve.von_mises})
      std::reverse(values->begin(), values->end());
    return curve;
  }

  const LoadedMeshProblem& problem_;
  const LoadedMeshSettings& settings_;
  const MeshBodies& bodies_;
  ContactSystem system_;
  int cycles_;
};

void check(const LoadedMeshProblem& problem) {
  if (problem.loads.empty() || problem.phases < 2) throw InputError("a loaded mesh needs a load and two phases");
  for (std::size_t i = 0; i < problem.loads.size(); ++i)
    if (!(problem.loads[i] > (i > 0 ? problem.loads[i - 1] : 0.0)))
      throw InputError("the loads of a stiffness table have to be positive and strictly increasing");
  if (!problem.pair.internal() && !std::holds_alternative<OutsideHeld>(problem.structure))
    throw InputError("a ring structure belongs to the ring mesh");
}

}  // namespace

LoadedMeshResult solve_loaded_mesh(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings) {
  check(problem);
  const FlankContact flanks(problem.pair);
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto since = [&](auto start) { return std::chrono::duration<double>(now() - start).count(); };

  const int last_level = settings.rung == Rung::solid ? last_solid_level : last_plane_level;
  const int first_level = settings.level.value_or(1);
  if (first_level < 1 || first_level > last_level)
    throw InputError(fmt::format("level {} is not available: 1 to {} are", first_level, last_level));

  double mesh_seconds = 0, condense_seconds = 0, contact_seconds = 0, worst = 0;
  MeshBodies bodies;
  const auto solve_level = [&](int level) {
    bodies = build_bodies(problem, flanks, settings, level);
    mesh_seconds += bodies.mesh_seconds;
    condense_seconds += bodies.condense_seconds;
    const auto start = now();
    auto positions = PositionRun(problem, settings, flanks, bodies, level).solve([&](double f) {
      if (settings.progress) settings.progress((level - first_level + f) / (level - first_level + 2));
    });
    contact_seconds += since(start);
    return positions;
  };

  auto coarser = solve_level(first_level - 1);
  std::vector<LoadedPosition> positions;
  int level = first_level;
  for (;; ++level) {
    positions = solve_level(level);
    // The error falls at least with the square of the cell size where the contact dominates, so that the difference of
    // two levels overestimates that of the finer one; near singular edges of a support it falls more slowly and the
    // difference is about the error itself.
    worst = 0;
    const std::size_t loads = problem.loads.size(), nominal = loads / 2;
    std::vector<double> difference(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
      difference[i] = std::abs(coarser[i].entry.stiffness_secant / positions[i].entry.stiffness_secant - 1);
    // Along the mesh cycle the difference changes its sign here and there, where it says nothing about the error: the
    // largest of a sixteenth of a cycle to either side counts.
    const auto along = static_cast<std::ptrdiff_t>(positions.size() / loads);
    const std::ptrdiff_t reach = (problem.phases + 15) / 16;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      auto& entry = positions[i].entry;
      const auto at = static_cast<std::ptrdiff_t>(i / loads);
      for (std::ptrdiff_t k = at - reach; k <= at + reach; ++k) {
        // The last position is the first of the next cycle; a table that repeats closes on itself.
        const std::ptrdiff_t wrapped = (k + along - 1) % (along - 1);
        entry.error_relative = std::max(entry.error_relative, difference[wrapped * loads + i % loads]);
      }
      if (i % loads == nominal) worst = std::max(worst, entry.error_relative);
    }
    if (settings.level || worst <= settings.accuracy) break;
    if (level == last_level)
      throw SolverError(
          fmt::format("the mesh stiffness reached a relative accuracy of {:.2g} at the finest resolution, not "
                      "the wanted {:.2g}: ask for less accuracy",
                      worst, settings.accuracy));
    coarser = std::move(positions);
  }
  std::vector<StressCurve> curves = PositionRun(problem, settings, flanks, bodies).curves(positions);
  double reciprocity = 0;
  for (const auto& p : positions) reciprocity = std::max(reciprocity, p.reciprocity_relative);

  const int loads = static_cast<int>(problem.loads.size()), cycles = repeating_teeth(problem);
  const std::size_t table_size = static_cast<std::size_t>(cycles) * problem.phases * loads;
  std::vector<double> ring_angles;
  std::vector<StiffnessEntry> entries;
  for (std::size_t i = 0; i < table_size; ++i) entries.push_back(positions[i].entry);
  ring_angles.reserve(cycles);
  for (int c = 0; c < cycles; ++c)
    ring_angles.push_back(positions[static_cast<std::size_t>(c) * problem.phases * loads].ring_angle);
  double closure = 0;
  for (int l = 0; l < loads; ++l)
    closure = std::max(closure, std::abs(positions[table_size + l].entry.lte / positions[l].entry.lte - 1));

  StiffnessTable table(problem.pair.internal() ? "ring_planet" : "sun_planet", problem.phases, std::move(ring_angles),
                       problem.loads, std::move(entries));
  LoadedMeshResult result{std::move(table), std::move(positions)};
  result.closure_relative = closure;
  result.reciprocity_relative = reciprocity;
  result.planet_sector = std::move(bodies.planet_sector);
  result.wheel_sector = std::move(bodies.wheel_sector);
  result.level = level;
  result.worst_error_relative = worst;
  result.unknowns = bodies.unknowns;
  if (bodies.supports) {
    const auto& sites = bodies.supports->plan().sites();
    result.pin_stiffness = sites.sites.front().directions.front().total_stiffness();
    // The frame of the solve is the mirror image of the real ring.
    for (int pin = 0; pin < sites.pins; ++pin) result.pin_angles.push_back(-sites.sites[pin].angle);
  }
  result.slice_edges = bodies.slice_edges;
  result.stress_curves = std::move(curves);
  result.mesh_seconds = mesh_seconds;
  result.condense_seconds = condense_seconds;
  result.contact_seconds = contact_seconds;
  return result;
}

}  // namespace annulus::fem
