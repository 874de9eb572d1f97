#pragma once

#include <vector>

#include "app/scene/scene.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/structure_keys.h"
#include "fem/problem/structures/pin_held.h"

/// Rings on pins or bolts in a scene.
namespace annulus::app {

void declare_pins(const StructureKeys& keys);
/// Pins have room beside each other; a single one gets the bore of the housing that it needs.
void check_pins(RingInput& ring, Scene& scene, std::vector<Problem>& problems);
/// Radially: a pin lifts off, a bolt holds both ways.
enum class PinContact { unilateral, both_ways };
[[nodiscard]] fem::PinHeld on_pins(const RingInput& ring, PinContact contact);

}  // namespace annulus::app
