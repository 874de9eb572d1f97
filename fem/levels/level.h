#pragma once

#include <functional>
#include <vector>

#include "fem/contact/contact_system.h"
#include "fem/contact/flank_contact.h"
#include "fem/levels/error_estimate.h"
#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// How many phases lie between those at which levels are compared: they are 32 or a few more in a mesh cycle.
[[nodiscard]] int compared_stride(const LoadedMeshProblem& problem);
/// Whether a position is among those by which levels are compared: at the phases above, and of more than three loads
/// the smallest, the middle and the largest one.
[[nodiscard]] bool is_compared(const LoadedMeshProblem& problem, int phase, int load);

/// What one level of resolution of a loaded mesh gives.
struct SolvedLevel : SolvedBodies, SolveCost {
  /// [cycle][phase 0 ... phases][load]: the last phase of the last cycle is the closure, inner ends of cycles are not
  /// solved twice. A stiffness of 0 marks a position that was left out.
  std::vector<LoadedPosition> positions;
  OwnErrors own{};  ///< no contact error where the pressure is refined with the cells
};

using ProgressFunction = std::function<void(double fraction)>;
/// Called when the compared positions of a level are solved. Returns whether the level becomes the table; the other
/// positions are then solved, with stresses and fields. Empty: it does not become the table.
using AcceptLevel = std::function<bool(SolvedLevel& compared)>;

/// Condensed gears whose meshes do not follow the contact: the plane and solid models.
[[nodiscard]] SolvedLevel solve_condensed_level(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                                const FlankContact& flanks, int level, const AcceptLevel& accept,
                                                const ProgressFunction& progress);
/// Teeth meshed anew for every contact: the resolved models.
[[nodiscard]] SolvedLevel solve_resolved_level(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                               const FlankContact& flanks, int level, const AcceptLevel& accept,
                                               const ProgressFunction& progress);

/// What the positions of one task share.
struct PositionTask {
  /// A position whose stresses are yet to be found from its forces.
  struct Solved {
    LoadedPosition* position = nullptr;
    int load = 0;  ///< its number
    ContactForces forces{};
  };
  ContactSystem::PairsCache cache{};
  ContactSystem::WarmStart warm{};
  std::vector<Solved> without_stress{};
};
struct PositionSolver {
  /// Solves one position: mesh cycle, number of the phase, number of the load.
  std::function<void(int cycle, int phase, int load, PositionTask& task, LoadedPosition& position)> solve;
  /// Finds what is without stress in a task, many positions at once: their products read the large matrices of a body
  /// once. Empty: `solve` leaves nothing.
  std::function<void(std::vector<PositionTask::Solved>& solved)> find_stresses{};
};
/// Reports the progress of a part of the work to `progress`, scaled to [from, to].
[[nodiscard]] ProgressFunction part_of(const ProgressFunction& progress, double from, double to);
/// The compared positions over all.
[[nodiscard]] double compared_share(const LoadedMeshProblem& problem);
/// Which positions are solved: the compared ones alone, or all of the table that are not solved yet.
enum class PositionsOf { comparison, table };
/// The tasks in which they are solved. by_load: the phases of a load, which warm-start each other. by_phase: the mesh
/// cycles of one load and phase, from each of which the pins move on to the next.
enum class PositionTasks { by_load, by_phase };
/// The positions of one level on the threads of the settings: never dependent on their number.
void solve_positions(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, PositionsOf wanted,
                     PositionTasks tasks, const PositionSolver& solver, const ProgressFunction& progress,
                     std::vector<LoadedPosition>& positions);

}  // namespace annulus::fem
