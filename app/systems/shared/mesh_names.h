#pragma once

namespace annulus::app {

/// Names of the meshes of several kinds, in files, keys and tables.
inline constexpr const char *sun_planet = "sun_planet", *ring_planet = "ring_planet", *pinion_wheel = "pinion_wheel",
                            *arc_pins = "arc_pins";

}  // namespace annulus::app
