#include "fem/closed_form/ring_supports.h"

#include "core/errors.h"
#include "fem/problem/support_sites.h"

namespace annulus::fem {

std::vector<RingSupport> ring_supports(const RingStructure& structure, double outside_radius, double width,
                                       int ring_teeth, const Material& material) {
  if (std::holds_alternative<OutsideHeld>(structure)) return {};
  const SupportedRing ring{ring_teeth, outside_radius, width, material};
  SupportSites sites;
  if (const auto* pins = std::get_if<PinHeld>(&structure))
    sites = pin_sites(*pins, ring);
  else if (const auto* spline = std::get_if<SplineHeld>(&structure))
    sites = spline_sites(*spline, ring);
  else
    throw InputError(
        "a ring held at an end face or a flange bends along its width, for which the closed form has no honest "
        "formula: use model = \"solid\"");
  std::vector<RingSupport> supports;
  for (const auto& site : sites.sites)
    for (const auto& direction : site.directions)
      supports.push_back({site.angle, site.half_arc, site.parabolic ? Spread::parabolic : Spread::uniform,
                          direction.inward, direction.counter_clockwise, direction.total_stiffness(),
                          direction.clearance, direction.unilateral});
  return supports;
}

}  // namespace annulus::fem
