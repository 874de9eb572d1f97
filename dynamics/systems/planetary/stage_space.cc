#include "dynamics/systems/planetary/stage_space.h"

#include <fmt/format.h>

#include <utility>

#include "dynamics/system/input_checks.h"

namespace annulus::dynamics {

void StageSpace::check(int planets) const {
  for (const auto& [inertia, name] : {std::pair{tilt_inertia.sun, "sun"},
                                      {tilt_inertia.ring, "ring"},
                                      {tilt_inertia.carrier, "carrier"},
                                      {tilt_inertia.planet, "planet"}})
    check_positive(inertia, fmt::format("tilting inertia of the {}", name));
  sun_face.check("sun meshes");
  ring_face.check("ring meshes");
  check_supports(planets);
}

}  // namespace annulus::dynamics
