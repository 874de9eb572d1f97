#pragma once

#include <vector>

#include "fem/condensation/condensed_sector.h"
#include "fem/elasticity/arc_load.h"
#include "fem/elasticity/sector_model.h"
#include "fem/problem/byte_stream.h"

namespace annulus::fem {

/// Condensed sectors as bytes, and all they depend on, for the cache.
void write(ByteWriter& out, const CondensedSector& sector);
[[nodiscard]] CondensedSector read_sector(ByteReader& in);
void write(ByteWriter& out, const OutsideLoads& outside);
[[nodiscard]] OutsideLoads read_outside(ByteReader& in);

/// What the model of a sector depends on.
void add_sector_inputs(ByteWriter& inputs, const geometry::Mesh& mesh, const geometry::ToothProfile& profile,
                       double support_radius, const Material& material, const SectorModelOptions& options);
/// What the unit loads of its outside depend on: the slices of the arcs, not their places.
void add_slices(ByteWriter& inputs, const std::vector<ArcLoad>& arcs);

}  // namespace annulus::fem
