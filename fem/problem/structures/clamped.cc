#include "fem/problem/structures/clamped.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"
#include "fem/problem/support_sites.h"

namespace annulus::fem {

RingBody Clamped::body(double outside_radius) const {
  if (!(inner_radius > 0 && inner_radius < outside_radius))
    throw InputError(
        fmt::format("a clamped ring is held from an inner radius of {:.7g} mm out to its outside radius of {:.7g} mm: "
                    "the inner one has to be positive and smaller",
                    1e3 * inner_radius, 1e3 * outside_radius));
  RingBody body;
  body.held = HeldSurface::both_end_faces;
  body.held_inner_radius = inner_radius;
  return body;
}

RingWords Clamped::words() const {
  RingWords words;
  words.name = "clamped";
  words.description = "clamped between two housings";
  if (bolts > 0) words.description += fmt::format(" by {} bolt{}", bolts, bolts == 1 ? "" : "s");
  if (dowels > 0) words.description += fmt::format(" and {} dowel{}", dowels, dowels == 1 ? "" : "s");
  words.solid_reason =
      "the ring is clamped at both end faces, so the deflection increases towards the middle of the face";
  return words;
}

std::vector<std::pair<std::string, double>> Clamped::parameters() const {
  return {{"clamp_inner_radius", inner_radius}};
}

RingDrawing Clamped::drawing(double /*outside_radius*/) const {
  RingDrawing drawing;
  if (bolts > 0)
    drawing.cylinders.push_back(
        {bolts == 1 ? "bolt" : "bolts", equal_angles(bolts, first_bolt_angle), bolt_circle_radius, bolt_diameter});
  if (dowels > 0) {
    const double between = bolts > 0 ? M_PI / bolts : 0;
    auto angles = equal_angles(dowels, first_bolt_angle);
    // Between the bolt at or before the equally spaced position and the next one.
    for (auto& angle : angles) {
      const double step = 2 * between;
      if (step > 0) angle = first_bolt_angle + std::floor((angle - first_bolt_angle) / step + 1e-9) * step + between;
    }
    drawing.cylinders.push_back({dowels == 1 ? "dowel" : "dowels", angles, bolt_circle_radius, dowel_diameter});
  }
  return drawing;
}

}  // namespace annulus::fem
