#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "core/figure.h"
#include "geometry/planetary.h"

namespace annulus::app {

/// What the rollers of a planet carry where they carry most, as one of its meshes was solved: at the nominal load, at
/// angles from the direction away from the axis of the stage.
struct RollerLoads {
  std::vector<double> angle;        ///< rad, ascending, from -270 to 90 degrees: about the middle of the load zone
  std::vector<double> load, rigid;  ///< N/rad: of the planet, and of one whose rim stays round
  double largest = 0, largest_rigid = 0;
  double load_zone = 0, rigid_load_zone = 0;  ///< rad, all angles at which rollers carry
  double mesh_phase = 0;
};

/// Nothing for planets that do not stand on rollers.
[[nodiscard]] std::optional<RollerLoads> roller_loads(const Scene& scene, const geometry::PlanetarySet& set,
                                                      const MeshResult& mesh);

/// Results of the planet's rollers under one of its meshes; keys begin with its name.
[[nodiscard]] std::vector<FigureSpec> roller_figure_specs(const std::string& mesh, const std::string& title);
/// Their values; the errors are not known.
[[nodiscard]] FigureSet figures(const RollerLoads& loads, const std::string& mesh);

}  // namespace annulus::app
