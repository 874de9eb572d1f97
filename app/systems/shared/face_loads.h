#pragma once

#include "app/model/moving_faces.h"
#include "app/systems/shared/space_results.h"
#include "core/csv.h"

/// The load along the faces of gears that tilt in motion.
namespace annulus::app {

/// Finds the load along every face in the mesh cycle in which the motion tilts it most: straight flanks of the face
/// itself carry the force in its place. Solid gears need another tilt for that than the reduced face of the motion
/// (FaceShape). `deviation` is the moment by which the latter errs at the tilt of the motion, over half the face width
/// and the mean force. The error of K_Hβ is three times the mean of that moment over the cycle: its change at the end
/// of an even face. Meshes whose force leaves the face, or whose contact cannot be solved, have no Face.
void add_face_loads(SpaceResults& results, const MovingFaces& faces, int threads);

/// Columns <mesh>_at_m, <mesh>_mean_N_per_m.
[[nodiscard]] Csv face_loads_table(const SpaceResults& results);

}  // namespace annulus::app
