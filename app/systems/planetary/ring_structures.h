#pragma once

#include <optional>
#include <vector>

#include "app/scene/scene_declare.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/stage_geometry.h"
#include "fem/problem/ring_structure.h"

/// Ring structures in a scene: their keys, the rules between these, and the structure that the elastic models see.
namespace annulus::app {

/// The key `structure`, and the keys of all structures.
void declare_structure(Declarations<RingInput>& ring);
void declare_structure_keys(Declarations<RingInput>& ring);

/// Dimensions of a ring of this scene that have to agree: flange, hoop, pins, clamp. A single pin gets the bore that it
/// needs. Problems are appended, never thrown.
void check_structure(RingInput& ring, Scene& scene, std::vector<Problem>& problems);
/// Throws GeometryError where a structure does not fit into the rim of its ring.
void check_structure_in_rim(const Scene& scene, const RingInput& input, const RingGeometry& ring);

/// The structure in the mirror image of its ring (y -> -y): places of its supports count the other way round.
void mirror_structure(RingInput& ring);

/// The structure that the scene asks for, as the elastic models know it. Keys that a faulty scene leaves out count as
/// zero: its words can be asked for while it is checked.
[[nodiscard]] fem::RingStructure ring_structure(const RingInput& ring);

}  // namespace annulus::app
