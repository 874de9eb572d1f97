#include "fem/levels/level.h"

#include <algorithm>
#include <mutex>

#include "core/parallel.h"
#include "fem/problem/problem_check.h"

namespace annulus::fem {

int compared_stride(const LoadedMeshProblem& problem) {
  constexpr int enough_phases = 32;
  return std::max(1, problem.phases / enough_phases);
}

bool is_compared(const LoadedMeshProblem& problem, int phase, int load) {
  constexpr int enough_loads = 3;
  const int loads = static_cast<int>(problem.loads.size());
  if (phase % compared_stride(problem) != 0) return false;
  return loads <= enough_loads || load == 0 || load == loads / 2 || load == loads - 1;
}

ProgressFunction part_of(const ProgressFunction& progress, double from, double to) {
  if (!progress) return {};
  return [=](double fraction) { progress(from + fraction * (to - from)); };
}

double compared_share(const LoadedMeshProblem& problem) {
  const int loads = static_cast<int>(problem.loads.size());
  int compared = 0;
  for (int phase = 0; phase < problem.phases; ++phase)
    for (int load = 0; load < loads; ++load) compared += is_compared(problem, phase, load);
  return static_cast<double>(compared) / (problem.phases * loads);
}

void solve_positions(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, PositionsOf wanted,
                     PositionTasks tasks, const PositionSolver& solver, const ProgressFunction& progress,
                     std::vector<LoadedPosition>& positions) {
  const int loads = static_cast<int>(problem.loads.size()), phases = problem.phases;
  const int cycles = problem.structure.repeating_teeth(problem.pair.wheel().teeth());
  positions.resize(static_cast<std::size_t>(cycles * phases + 1) * loads);
  const bool by_load = tasks == PositionTasks::by_load;
  const int count = by_load ? loads : loads * (phases + 1);
  int done = 0;
  std::mutex lock;
  for_each_task(count, settings.threads, [&](std::size_t task) {
    const int load = static_cast<int>(task) % loads;
    const int first_phase = by_load ? 0 : static_cast<int>(task) / loads, last_phase = by_load ? phases : first_phase;
    PositionTask state;
    const auto find_stresses = [&](std::size_t from) {
      if (state.without_stress.size() < from || state.without_stress.empty()) return;
      solver.find_stresses(state.without_stress);
      state.without_stress.clear();
    };
    constexpr std::size_t at_once = 16;
    for (int phase = first_phase; phase <= last_phase; ++phase) {
      if (wanted == PositionsOf::comparison && !is_compared(problem, phase, load)) continue;
      for (int cycle = phase == phases ? cycles - 1 : 0; cycle < cycles; ++cycle) {
        auto& position = positions[static_cast<std::size_t>(cycle * phases + phase) * loads + load];
        if (position.entry.stiffness_secant != 0) continue;
        solver.solve(cycle, phase, load, state, position);
        find_stresses(at_once);
        check_deflection(problem, settings, position);
        if (load != loads / 2) position.pressure.clear();
      }
    }
    find_stresses(1);
    const std::lock_guard guard(lock);
    ++done;
    if (progress) progress(static_cast<double>(done) / count);
  });
  check_rise(problem, positions);
}

}  // namespace annulus::fem
