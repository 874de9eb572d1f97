#pragma once

#include "app/scene/scene.h"
#include "fem/loaded_mesh.h"

namespace annulus::app {

/// The structure that the scene asks for, as the elastic models know it. Keys that a faulty scene leaves out count as
/// zero: its words can be asked for while it is checked.
[[nodiscard]] fem::RingStructure ring_structure(const RingInput& ring);

}  // namespace annulus::app
