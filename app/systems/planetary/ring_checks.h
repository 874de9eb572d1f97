#pragma once

#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

/// Dimensions of a ring of this scene that have to agree: flange, hoop, pins, clamp. A single pin gets the bore that it
/// needs. Problems are appended, never thrown.
void check_ring(RingInput& ring, Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
