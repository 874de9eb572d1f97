#pragma once

#include "app/model/mesh_result.h"
#include "core/csv.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// What strain gauges on the ring show in motion, as lines over the mesh order: every planet strains the ring as it
/// passes (MeshResult::gauges), in proportion to its force at that moment. Passing planets and their forces so make
/// sidebands about the multiples of the mesh frequency [McFaddenSmith1985]. Columns: mesh_order, carrier_order (in
/// revolutions of the carrier against the ring), frequency_Hz, gauge_1_um_per_m ... Lines below 1e-4 of the highest are
/// left out. Empty without gauges, and where motion and revolution do not repeat together within 20 000 mesh cycles.
/// `response`: with its series.
[[nodiscard]] Csv gauge_spectrum(const dynamics::PlanetaryStage& stage, const MeshResult& ring_mesh,
                                 const dynamics::DynamicResponse& response);

}  // namespace annulus::app
