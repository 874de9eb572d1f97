#pragma once

#include <vector>

#include "app/model/mesh_result.h"
#include "app/scene/key_checks.h"
#include "app/scene/scene_schema.h"
#include "dynamics/systems/planetary/planetary_stage.h"
#include "geometry/planetary.h"

/// Pitch deviations of single teeth: from the scene to the errors of the meshes.
namespace annulus::app {

/// Keys of [errors].
[[nodiscard]] Table pitch_deviation_keys();
/// One value per tooth, and teeth that close the circle.
void check_pitch_deviations(Scene& scene, std::vector<Problem>& problems);
/// In the mirror image the teeth count the other way round.
void mirror_pitch_deviations(Scene& scene);

/// The error of a mesh, m, over as many mesh cycles as there are gaps: `gaps[c]` (m, along the line of action) is that
/// of the pair which meets at the pitch point after c cycles. At a given load the transmission error changes by the sum
/// of gaps times load shares, exactly as long as the same pairs carry: by reciprocity a gap works on the force of its
/// pair alone.
[[nodiscard]] PeriodicCurve error_of_gaps(const std::vector<double>& gaps, const PairShares& shares);

/// Sets the tooth errors of all meshes.
void add_pitch_deviations(const Scene& scene, const geometry::PlanetarySet& set, const MeshResult& sun_mesh,
                          const MeshResult& ring_mesh, dynamics::PlanetaryStage& stage);

}  // namespace annulus::app
