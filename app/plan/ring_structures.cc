#include "app/plan/ring_structures.h"

namespace annulus::app {

namespace {

fem::RingStructure traditional(const RingInput& ring) {
  if (ring.flange_width) return fem::FlangeHeld{*ring.flange_width, ring.flange_diameter.value_or(0) / 2};
  return fem::OutsideHeld{};
}

fem::EndFaceHeld thin_walled(const RingInput& ring) {
  fem::EndFaceHeld held{.free_length = ring.free_length.value_or(0),
                        .sleeve_thickness = ring.sleeve_thickness.value_or(0)};
  if (ring.hoop_width) held.hoop = fem::Hoop{*ring.hoop_width, ring.hoop_thickness.value_or(0)};
  return held;
}

fem::SplineHeld splined(const RingInput& ring) {
  return {.teeth = ring.splines.value_or(0),
          .flank_angle = ring.spline_flank_angle.value_or(0),
          .clearance = ring.spline_clearance.value_or(0),
          .flank_stiffness = ring.spline_stiffness,
          .first_tooth_angle = ring.first_spline_angle.value_or(0)};
}

fem::PinHeld on_pins(const RingInput& ring, bool unilateral) {
  return {.angles = ring.pins ? fem::equal_angles(*ring.pins, ring.first_pin_angle.value_or(0)) : ring.pin_angles,
          .pin_diameter = ring.pin_diameter.value_or(0),
          .clearance = ring.pin_clearance.value_or(0),
          .free_span = ring.pin_free_span.value_or(0),
          .radial_stiffness = ring.pin_radial_stiffness,
          .tangential_stiffness = ring.pin_tangential_stiffness,
          .housing_clearance = ring.housing_clearance,
          .unilateral = unilateral};
}

fem::Clamped clamped(const RingInput& ring) {
  return {.inner_radius = ring.clamp_inner_diameter.value_or(0) / 2,
          .bolts = ring.bolts.value_or(0),
          .bolt_circle_radius = ring.bolt_circle_diameter.value_or(0) / 2,
          .bolt_diameter = ring.bolt_diameter.value_or(0),
          .first_bolt_angle = ring.first_bolt_angle.value_or(0),
          .dowels = ring.dowels.value_or(0),
          .dowel_diameter = ring.dowel_diameter.value_or(0)};
}

}  // namespace

fem::RingStructure ring_structure(const RingInput& ring) {
  switch (ring.structure) {
    case Structure::traditional:
      return traditional(ring);
    case Structure::thin_walled:
      return thin_walled(ring);
    case Structure::pinned:
      return on_pins(ring, true);
    case Structure::bolted:
      return on_pins(ring, false);
    case Structure::splined:
      return splined(ring);
    case Structure::clamped:
      break;
  }
  return clamped(ring);
}

}  // namespace annulus::app
