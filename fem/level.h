#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "fem/contact/contact_system.h"
#include "fem/contact/flank_contact.h"
#include "fem/loaded_mesh.h"

namespace annulus::fem {

/// What one level of resolution of a loaded mesh gives.
struct SolvedLevel {
  /// [cycle][phase 0 ... phases][load]: the last phase of the last cycle is the closure, inner ends of cycles are not
  /// solved twice.
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
                                                const FlankContact& flanks, int level,
                                                const ProgressFunction& progress);
/// Teeth meshed anew for every contact: the resolved rungs.
[[nodiscard]] SolvedLevel solve_resolved_level(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings,
                                               const FlankContact& flanks, int level, const ProgressFunction& progress);

/// Solves one position: mesh cycle, number of the phase, number of the load. Cache and warm start are those of the task
/// that the position belongs to.
using SolvePosition = std::function<LoadedPosition(int cycle, int phase, int load, ContactSystem::PairsCache& cache,
                                                   ContactSystem::WarmStart& warm)>;
/// All positions of one level on the threads of the settings: never dependent on their number.
[[nodiscard]] std::vector<LoadedPosition> solve_positions(const LoadedMeshProblem& problem,
                                                          const LoadedMeshSettings& settings, bool chained,
                                                          const SolvePosition& solve, const ProgressFunction& progress);

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
