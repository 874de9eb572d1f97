#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "fem/contact/contact_system.h"
#include "fem/contact/flank_contact.h"
#include "fem/loaded_mesh.h"

namespace annulus::fem {

/// What a level is solved for.
enum class LevelUse {
  table,       ///< everything that is told of it
  comparison,  ///< the estimate of the level after it alone: some of the positions, without stresses
};

/// Whether a position is among those by which levels are compared: 32 or a few more phases of a mesh cycle, and of more
/// than three loads the smallest, the middle and the largest one.
[[nodiscard]] bool is_compared(const LoadedMeshProblem& problem, int phase, int load);

/// What one level of resolution of a loaded mesh gives.
struct SolvedLevel {
  /// [cycle][phase 0 ... phases][load]: the last phase of the last cycle is the closure, inner ends of cycles are not
  /// solved twice. Solved for comparison, a stiffness of 0 says that the position was left out.
  std::vector<LoadedPosition> positions;
  std::vector<StressCurve> stress_curves;
  std::vector<BodyField> fields;
  geometry::Mesh planet_sector, wheel_sector;
  bool half_face = false;
  long unknowns = 0;
  /// Relative, of the stiffness, by the discretised pressure alone; 0 where the pressure is refined with the cells.
  double contact_error = 0;
  double pin_stiffness = 0;
  std::vector<double> pin_angles, slice_edges;
  double mesh_seconds = 0, condense_seconds = 0, contact_seconds = 0, saved_seconds = 0;
  int condensed_teeth = 0, reused_teeth = 0;
};

using ProgressFunction = std::function<void(double fraction)>;

/// Condensed gears whose meshes do not follow the contact: the plane and solid rungs.
[[nodiscard]] SolvedLevel solve_condensed_level(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                                const FlankContact& flanks, int level, LevelUse use,
                                                const ProgressFunction& progress);
/// Teeth meshed anew for every contact: the resolved rungs.
[[nodiscard]] SolvedLevel solve_resolved_level(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                               const FlankContact& flanks, int level, LevelUse use,
                                               const ProgressFunction& progress);

/// Solves one position: mesh cycle, number of the phase, number of the load. Cache and warm start are those of the task
/// that the position belongs to.
using SolvePosition = std::function<LoadedPosition(int cycle, int phase, int load, ContactSystem::PairsCache& cache,
                                                   ContactSystem::WarmStart& warm)>;
/// The positions of one level on the threads of the settings: never dependent on their number.
[[nodiscard]] std::vector<LoadedPosition> solve_positions(const LoadedMeshProblem& problem,
                                                          const LoadedMeshSettings& settings, LevelUse use,
                                                          bool chained, const SolvePosition& solve,
                                                          const ProgressFunction& progress);

/// Wall seconds since the construction.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace annulus::fem
