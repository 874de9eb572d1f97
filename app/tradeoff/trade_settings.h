#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/plan/mesh_model.h"
#include "dynamics/response.h"

namespace annulus::app {

/// What a setting belongs to.
enum class TradePart { mesh, dynamics };

/// How stiffness tables are computed.
struct MeshSetting {
  fem::Rung rung = fem::Rung::plane;
  int degree = 2, level = 1;  ///< without meaning for the closed form
  int phases = table_phases;
  int loads = 5;  ///< 1, 3, 5 or 9 of them around the nominal one
  bool finest = false;

  [[nodiscard]] std::string text() const;    ///< "degree 2, level 1, 32 phases, 5 loads"
  [[nodiscard]] std::string folder() const;  ///< "plane_d2_l1_p32_n5"
  /// A solid setting is solved in the plane, alike otherwise, where nothing changes along the face width.
  [[nodiscard]] MeshModel applied(const MeshModel& planned, bool needs_solid) const;
};

/// All that can represent a mesh: rungs, degrees and levels with the usual table, tables of other resolution, and last
/// the finest of all.
[[nodiscard]] std::vector<MeshSetting> mesh_settings(const MeshModel& planned, bool needs_solid);

/// How the lumped model is made and solved.
struct DynamicsSetting {
  std::string rung;      ///< "direct", "marching" or "fewer freedoms", "coupling"
  std::string settings;  ///< "64 samples per cycle", "ARKODE, tolerance 1e-6"
  std::function<void(dynamics::PlanetaryStage& stage, dynamics::SimulationOptions& options)> apply;
  bool finest = false;
  bool changes_model = false;  ///< its error is not one of numbers
};

/// Ways to solve `stage` as it stands, its static coupling included, and what leaving things out does. `elastic`: the
/// coupling with the modes of the ring (null: there are none).
[[nodiscard]] std::vector<DynamicsSetting> dynamics_settings(const dynamics::PlanetaryStage& stage,
                                                             const std::shared_ptr<const RingCoupling>& elastic);

}  // namespace annulus::app
