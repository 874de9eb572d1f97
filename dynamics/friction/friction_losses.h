#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/figure.h"
#include "dynamics/friction/flank_friction.h"

/// What friction on the flanks loses.
namespace annulus::dynamics {

/// What meshes of one sort lose.
struct MeshLosses {
  std::string mesh;
  double coefficient = 0;
  Figure power;  ///< W, of all of them
};
/// Equal meshes under their mean force, with friction in the transverse section (FlankFriction).
struct LossyMesh {
  std::string name;
  const geometry::GearPair* pair = nullptr;
  double frequency = 0;  ///< Hz, of its mesh cycles, positive
  double force = 0;      ///< N, transverse
  int number = 1;
};
/// The error of the power is its change with half of the phases of the shares (not known for an odd number of them),
/// and what friction changes of the force. `friction` belongs to `shares`.
[[nodiscard]] MeshLosses mesh_losses(const LossyMesh& mesh, const FlankFriction& friction, const PairShares& shares);

[[nodiscard]] const FigureSpec& efficiency_figure();
/// The results of meshes by name and title ("sun_planet", "sun mesh"), and the efficiency.
[[nodiscard]] std::vector<FigureSpec> friction_figure_specs(
    const std::vector<std::pair<std::string, std::string>>& meshes);
/// Of these results the efficiency, for studies; nothing where there is none.
[[nodiscard]] FigureSet efficiency_alone(const FigureSet& losses);
/// `power`: W, of the bodies that drive.
void add_losses(FigureSet& figures, const std::vector<MeshLosses>& losses, double power);

}  // namespace annulus::dynamics
