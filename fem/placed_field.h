#pragma once

#include "fem/problem/loaded_mesh_result.h"
#include "geometry/gear_pair.h"

namespace annulus::fem {

/// The field of a body in the frame of its pair at the position that it belongs to: the axis of the wheel is the z
/// axis, that of the pinion lies at the centre distance on +x, both bodies stand as they mesh (geometry::pair_places).
/// The displacement of the pinion contains its rotation by the deflection of the mesh: where flanks touch, they touch
/// at every exaggeration.
[[nodiscard]] BodyField in_frame_of_pair(const BodyField& field, const LoadedPosition& position,
                                         const geometry::GearPair& pair);

/// By what to multiply displacements for the eye: the largest is then a fiftieth of the bodies. Both in one unit.
[[nodiscard]] double visible_exaggeration(double size, double largest_displacement);

}  // namespace annulus::fem
