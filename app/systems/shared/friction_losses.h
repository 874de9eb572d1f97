#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/systems/shared/friction.h"
#include "core/figure.h"

/// What friction on the flanks loses.
namespace annulus::app {

/// What meshes of one sort lose.
struct MeshLosses {
  std::string mesh;
  double coefficient = 0;
  Figure power;  ///< W, of all of them
};
/// `number`: of equal meshes. The error of the power is its change with half of the phases at which shares are known
/// (not known for an odd number of them), and what friction changes of the force. Needs [friction].
[[nodiscard]] MeshLosses mesh_losses(const Scene& scene, const std::string& mesh, const RollingMesh& rolling,
                                     const PairShares& shares, int number);

[[nodiscard]] const FigureSpec& efficiency_figure();
/// The results of meshes by name and title ("sun_planet", "sun mesh"), and the efficiency.
[[nodiscard]] std::vector<FigureSpec> friction_figure_specs(
    const std::vector<std::pair<std::string, std::string>>& meshes);
/// Of these results the efficiency, for studies; nothing where there is none.
[[nodiscard]] FigureSet efficiency_alone(const FigureSet& losses);
/// `power`: W, of the bodies that drive.
void add_losses(FigureSet& figures, const std::vector<MeshLosses>& losses, double power);

}  // namespace annulus::app
