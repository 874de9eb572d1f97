#include "fem/problem/structures/clamped.h"

#include <fmt/format.h>

#include <cmath>

#include "fem/problem/support_sites.h"

namespace annulus::fem {

RingDescription Clamped::describe(double /*outside_radius*/) const {
  RingDescription d;
  d.body.held = HeldSurface::both_end_faces;
  d.body.held_inner_radius = inner_radius;
  d.words.name = "clamped";
  d.words.description = "clamped between two housings";
  if (bolts > 0) d.words.description += fmt::format(" by {} bolt{}", bolts, bolts == 1 ? "" : "s");
  if (dowels > 0) d.words.description += fmt::format(" and {} dowel{}", dowels, dowels == 1 ? "" : "s");
  d.words.solid_reason =
      "the ring is clamped at both end faces, so the deflection increases towards the middle of the face";
  d.parameters = {{"clamp_inner_radius", inner_radius}};
  if (bolts > 0)
    d.drawing.cylinders.push_back(
        {bolts == 1 ? "bolt" : "bolts", equal_angles(bolts, first_bolt_angle), bolt_circle_radius, bolt_diameter});
  if (dowels > 0) {
    const double between = bolts > 0 ? M_PI / bolts : 0;
    auto angles = equal_angles(dowels, first_bolt_angle);
    // Between the bolt at or before the equally spaced position and the next one.
    for (auto& angle : angles) {
      const double step = 2 * between;
      if (step > 0) angle = first_bolt_angle + std::floor((angle - first_bolt_angle) / step + 1e-9) * step + between;
    }
    d.drawing.cylinders.push_back({dowels == 1 ? "dowel" : "dowels", angles, bolt_circle_radius, dowel_diameter});
  }
  return d;
}

}  // namespace annulus::fem
