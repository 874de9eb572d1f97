#include "fem/problem/structures/surface_held.h"

namespace annulus::fem {

RingDescription FlangeHeld::describe(double /*ring_outside_radius*/) const {
  RingDescription d;
  d.body.held = HeldSurface::flange_face;
  d.body.flange = Flange{width, outside_radius};
  d.words.name = "flange_held";
  d.words.description = "fixed by a flange";
  d.words.solid_reason = "a flange holds the ring at one end, so the deflection increases towards the other";
  d.words.asymmetry = "fixed by a flange at one end";
  d.parameters = {{"flange_width", width}, {"flange_radius", outside_radius}};
  return d;
}

RingDescription EndFaceHeld::describe(double outside_radius) const {
  RingDescription d;
  d.body.held = HeldSurface::low_end_face;
  d.body.held_inner_radius = outside_radius - sleeve_thickness;
  d.body.sleeve = Sleeve{free_length, sleeve_thickness};
  d.body.hoop = hoop;
  d.words.name = "end_face_held";
  d.words.description = free_length > 0 ? "on a sleeve" : "fixed at its end face";
  d.words.solid_reason = "the ring is cantilevered from one end face, so the deflection increases towards its free end";
  d.words.asymmetry = "fixed at one end face";
  d.parameters = {{"free_length", free_length}, {"sleeve_thickness", sleeve_thickness}};
  if (hoop) {
    d.words.description += ", with a hoop";
    d.words.solid_reason += "; a hoop stiffens the free end";
    d.parameters.insert(d.parameters.end(), {{"hoop_width", hoop->width}, {"hoop_thickness", hoop->thickness}});
  }
  return d;
}

}  // namespace annulus::fem
