#pragma once

#include "core/face_shape.h"
#include "fem/solid_face.h"

namespace annulus::fem {

/// Tilt, over the approach, between which to either side a face is reduced a second time, for error bars
/// (FaceShape::tilted).
inline constexpr double reduced_face_tilt = 0.5;

/// The face of two solid gears reduced to its force and moment about straight flanks under `load` (N, normal to the
/// flanks), at so many phases of a mesh cycle. Any number of threads.
[[nodiscard]] FaceShape reduced_face(const SolidFace& face, double load, int phases, int threads);

}  // namespace annulus::fem
