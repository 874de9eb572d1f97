#pragma once

#include <optional>

#include "app/model/mesh_result.h"
#include "app/plan/warning.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::app {

/// How the sun and the ring mesh of a planet on rollers act on each other through its rim.
struct PlanetCoupling {
  /// m/N at the phases of the ring mesh (dynamics::PlanetaryStage::planet_coupling): the mean of what both meshes give.
  /// By reciprocity they give the same.
  std::vector<double> compliance;
  double deviation = 0;  ///< m/N, largest difference between that mean and either mesh
};
/// Nothing unless both meshes were computed with the planet on rollers.
[[nodiscard]] std::optional<PlanetCoupling> planet_coupling(const dynamics::PlanetaryStage& stage,
                                                            const MeshResult& sun_mesh, const MeshResult& ring_mesh);

/// The stage with a coupling that is larger by its deviation; nothing where it has none.
[[nodiscard]] std::optional<dynamics::PlanetaryStage> with_deviating_coupling(const dynamics::PlanetaryStage& stage,
                                                                              const MeshResult& sun_mesh,
                                                                              const MeshResult& ring_mesh);

/// Planets on rollers of which one mesh alone is computed.
void warn_of_coupling_left_out(std::vector<Warning>& list, const Scene& scene);

}  // namespace annulus::app
