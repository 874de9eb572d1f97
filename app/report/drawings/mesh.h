#pragma once

#include <string>

#include "fem/loaded_mesh.h"

namespace annulus::app {

/// Picture of the meshes of one gear mesh as solved, as an SVG document: in the plane several teeth of both bodies at
/// the pitch-point contact, in space a few teeth of the wheel in parallel projection, hidden surfaces removed.
/// `name` makes the identifiers in the document unique within a page.
[[nodiscard]] std::string mesh_picture(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshResult& solved,
                                       const std::string& name);

}  // namespace annulus::app
