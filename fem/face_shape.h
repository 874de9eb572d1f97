#pragma once

#include "core/face_shape.h"
#include "fem/solid_face.h"

namespace annulus::fem {

/// The face of two solid gears reduced to its force and moment about straight flanks under `load` (N, normal to the
/// flanks), at so many phases of a mesh cycle. Any number of threads.
[[nodiscard]] FaceShape reduced_face(const SolidFace& face, double load, int phases, int threads);

}  // namespace annulus::fem
