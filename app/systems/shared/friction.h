#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"
#include "core/pair_shares.h"
#include "dynamics/friction/friction_losses.h"

namespace annulus::geometry {
class GearPair;
}

/// Friction on involute flanks and the oil between them, as lumped models have them.
namespace annulus::app {

struct FrictionInput {
  std::optional<double> coefficient;           ///< else by the oil
  std::optional<double> viscosity, roughness;  ///< Pa s, m
  double lubricant_factor = 1;
};

struct SqueezeInput {
  double viscosity = 0, least_gap = 0;  ///< Pa s, m; no viscosity: no film
};

/// [friction], [squeeze_film]
[[nodiscard]] std::vector<Table> friction_tables();
[[nodiscard]] bool has_friction(const Scene& scene);

/// A mesh of a gear set at its operating point.
struct RollingMesh {
  const geometry::GearPair* pair = nullptr;
  double frequency = 0;  ///< Hz, of its mesh cycles, positive
  double force = 0;      ///< N, transverse
};

/// The forces of a mesh in a lumped model.
enum class MeshForces { normal, transverse };
/// Nothing without [friction].
[[nodiscard]] std::optional<dynamics::FlankFriction> flank_friction(const Scene& scene, const RollingMesh& rolling,
                                                                    const PairShares& shares, MeshForces forces);

/// What `number` of equal meshes lose. Needs [friction].
[[nodiscard]] dynamics::MeshLosses mesh_losses(const Scene& scene, const std::string& mesh, const RollingMesh& rolling,
                                               const PairShares& shares, int number);

/// Oil within the backlash of a mesh; nothing without [squeeze_film].
[[nodiscard]] std::optional<dynamics::SqueezeFilm> squeeze_film(const Scene& scene, const geometry::GearPair& pair,
                                                                MeshForces forces);

/// For meshes with a prescribed stiffness, by title.
void warn_of_shares(std::vector<Warning>& list, const Scene& scene, const std::vector<std::string>& prescribed);

}  // namespace annulus::app
