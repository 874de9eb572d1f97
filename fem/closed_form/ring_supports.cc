#include "fem/closed_form/ring_supports.h"

#include <fmt/format.h>

#include "core/errors.h"

namespace annulus::fem {

std::vector<RingSupport> ring_supports(const RingStructure& structure, double outside_radius, double width,
                                       int ring_teeth, const Material& material) {
  if (needs_solid(structure))
    throw InputError(fmt::format("formulas cannot represent a ring {}: {}; use model = \"solid\"",
                                 structure.words().description, structure.words().solid_reason));
  const SupportSites sites = structure.supports({ring_teeth, outside_radius, width, material});
  std::vector<RingSupport> supports;
  for (const auto& site : sites.sites)
    for (const auto& direction : site.directions)
      supports.push_back({site.angle, site.half_arc, site.parabolic ? Spread::parabolic : Spread::uniform,
                          direction.inward, direction.counter_clockwise, direction.total_stiffness(),
                          direction.clearance, direction.unilateral});
  return supports;
}

}  // namespace annulus::fem
