#include "fem/problem/structures/end_face_held.h"

namespace annulus::fem {

RingBody EndFaceHeld::body(double outside_radius) const {
  RingBody body;
  body.held = HeldSurface::low_end_face;
  body.held_inner_radius = outside_radius - sleeve_thickness;
  body.sleeve = Sleeve{free_length, sleeve_thickness};
  body.hoop = hoop;
  return body;
}

RingWords EndFaceHeld::words() const {
  RingWords words;
  words.name = "end_face_held";
  words.description = free_length > 0 ? "on a sleeve" : "held at its end face";
  words.solid_reason = "the ring is cantilevered from one end face, so the deflection increases towards its free end";
  words.asymmetry = "held at one end face";
  if (hoop) {
    words.description += ", with a hoop";
    words.solid_reason += "; a hoop stiffens the free end";
  }
  return words;
}

std::vector<std::pair<std::string, double>> EndFaceHeld::parameters() const {
  std::vector<std::pair<std::string, double>> list = {{"free_length", free_length},
                                                      {"sleeve_thickness", sleeve_thickness}};
  if (hoop) {
    list.emplace_back("hoop_width", hoop->width);
    list.emplace_back("hoop_thickness", hoop->thickness);
  }
  return list;
}

RingDrawing EndFaceHeld::drawing(double /*outside_radius*/) const { return {}; }

}  // namespace annulus::fem
