#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"
#include "core/figure.h"
#include "dynamics/friction/flank_friction.h"

namespace annulus::geometry {
class GearPair;
}

/// Friction on involute flanks: its coefficient, what it loses, and how lumped models see it.
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
/// Nothing without [friction]. Without load shares those of stiff teeth.
[[nodiscard]] std::optional<dynamics::FlankFriction> flank_friction(const Scene& scene, const RollingMesh& rolling,
                                                                    const PairShares& shares, MeshForces forces);

/// Oil within the backlash of a mesh; nothing without [squeeze_film].
[[nodiscard]] std::optional<dynamics::SqueezeFilm> squeeze_film(const Scene& scene, const geometry::GearPair& pair,
                                                                MeshForces forces);

/// What meshes of one sort lose.
struct MeshLosses {
  std::string mesh;
  double coefficient = 0;
  Figure power;  ///< W, of all of them
};
/// `number`: of equal meshes, without name. The error of the power is its change with half of the phases at which
/// shares are known, and what friction changes of the force. Needs [friction].
[[nodiscard]] MeshLosses mesh_losses(const Scene& scene, const RollingMesh& rolling, const PairShares& shares,
                                     int number);

[[nodiscard]] const FigureSpec& efficiency_figure();
/// The results of meshes by name and title ("sun_planet", "sun mesh"), and the efficiency.
[[nodiscard]] std::vector<FigureSpec> friction_figure_specs(
    const std::vector<std::pair<std::string, std::string>>& meshes);
/// Of these results the efficiency, for studies; nothing where there is none.
[[nodiscard]] FigureSet efficiency_alone(const FigureSet& losses);
/// `power`: W, of the bodies that drive.
void add_losses(FigureSet& figures, const std::vector<MeshLosses>& losses, double power);

/// For meshes with a prescribed stiffness, by title.
void warn_of_shares(std::vector<Warning>& list, const Scene& scene, const std::vector<std::string>& prescribed);

}  // namespace annulus::app
