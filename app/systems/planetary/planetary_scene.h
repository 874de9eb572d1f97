#pragma once

#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::app {

struct GearGeometry;

/// What the scene of a planetary stage has besides the common tables.
[[nodiscard]] std::vector<Table> planetary_tables();
/// [[ring]] with the keys of every ring structure (ring_table.cc).
[[nodiscard]] Table ring_table();

/// Lists of one value per planet get their zeros; values that have to agree are checked.
void check_planetary_scene(Scene& scene, std::vector<Problem>& problems);

/// Where a mesh is computed, its bodies need a rim: bores stay below the roots, outside diameters, sleeves and flanges
/// beyond them. Loads, supports and errors too large for small displacements are refused. Throws what model_limits.h
/// throws.
void check_planetary_geometry(const Scene& scene, const GearGeometry& geometry);
/// What is wrong with every gear by itself or, where all of them exist, with every ring and its planets. At most one
/// fault of each.
[[nodiscard]] std::vector<std::string> planetary_faults(const Scene& scene);

}  // namespace annulus::app
