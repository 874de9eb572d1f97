#include "geometry/gmsh/meshed_sector.h"
#include "geometry/gmsh/msh_file.h"
#include "geometry/meshing.h"

/// What core/loaded_library.h looks up.
extern "C" const annulus::geometry::Meshing annulus_meshing_table;
const annulus::geometry::Meshing annulus_meshing_table = {annulus::geometry::meshed_sector,
                                                          annulus::geometry::write_msh_file};
