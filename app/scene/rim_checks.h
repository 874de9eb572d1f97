#pragma once

#include "app/pair/pair_model.h"
#include "app/scene/scene.h"
#include "app/stage/gear_geometry.h"

namespace annulus::app {

/// Bodies that have to be meshed need a rim: bores stay below the roots, outside diameters, sleeves, flanges beyond
/// them. Throws GeometryError, starting with the key, where a mesh is computed whose bodies have none.
void check_rims(const Scene& scene, const GearGeometry& geometry);
void check_rims(const Scene& scene, const PairGeometry& geometry);
/// Of the sun and a planet of a 2K-V stage.
void check_rims(const Scene& scene, const geometry::GearPair& pair);

}  // namespace annulus::app
