#pragma once

#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "core/figure.h"

namespace annulus::app {

/// The results of the stiffness table of a mesh. Keys begin with the name of the mesh ("sun_planet"); `title` names it
/// for people ("sun mesh"), `quantity` is that of its mean stiffness ("sun_stiffness"). `bodies`: of involute gears
/// ("planet", "sun"), which may have face load factors and stresses.
[[nodiscard]] std::vector<FigureSpec> mesh_figure_specs(const std::string& mesh, const std::string& title,
                                                        const std::string& quantity,
                                                        const std::vector<std::string>& bodies = {});
/// Their values with errors, by the keys above.
[[nodiscard]] FigureSet mesh_figures(const MeshResult& mesh);

}  // namespace annulus::app
