#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/plan/mesh_model.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::app {

/// What a setting belongs to.
enum class TradePart { mesh, dynamics };

/// Whether something changes along the face width of a mesh, which only solid models contain.
enum class AlongFace { uniform, varying };

/// How stiffness tables are computed.
struct MeshSetting {
  fem::Fidelity fidelity = fem::Fidelity::plane;
  int degree = 2, level = 1;  ///< without meaning for the closed form
  int phases = fem::table_phases;
  int loads = 5;  ///< 1, 3, 5 or 9 of them around the nominal one
  bool finest = false;

  [[nodiscard]] std::string text() const;    ///< "degree 2, level 1, 32 phases, 5 loads"
  [[nodiscard]] std::string folder() const;  ///< "plane_d2_l1_p32_n5"
  /// A solid setting is solved in the plane, with everything else equal, on a uniform face.
  [[nodiscard]] MeshModel applied(const MeshModel& planned, AlongFace face) const;
};

/// All that can represent a mesh: models, degrees and levels with the usual table, tables of other resolution, and last
/// the finest of all.
[[nodiscard]] std::vector<MeshSetting> mesh_settings(const MeshModel& planned, AlongFace face);

/// Samples per mesh cycle of the finest harmonic balance.
inline constexpr int finest_samples = 128;

/// How a periodic motion is found.
struct MotionSetting {
  std::string fidelity;  ///< "harmonic balance", "time integration"
  std::string settings;  ///< "64 samples per mesh cycle", "BDF, relative tolerance 1e-06"
  std::function<void(dynamics::SimulationOptions& options)> apply;
  bool finest = false;
};

/// Settings for a motion that repeats after `period` mesh cycles; the finest last.
[[nodiscard]] std::vector<MotionSetting> motion_settings(double mesh_frequency, int period);
/// Settings for shooting; the finest last. Steps of one length are not among them: stiff bearings would need
/// thousands per mesh cycle.
[[nodiscard]] std::vector<MotionSetting> shooting_settings();

}  // namespace annulus::app
