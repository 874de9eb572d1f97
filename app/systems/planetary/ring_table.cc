#include "app/scene/gear_tables.h"
#include "app/systems/planetary/planetary_scene.h"

namespace annulus::app {

namespace {

using RingDeclarations = Declarations<RingInput>;

void declare_ring_body(RingDeclarations& ring) {
  ring.key("name", &RingInput::name, "Name, also of the folder of its results.").required();
  ring.choice(
          "structure", &RingInput::structure,
          {{"traditional", Structure::traditional},
           {"thin_walled", Structure::thin_walled},
           {"pinned", Structure::pinned},
           {"bolted", Structure::bolted},
           {"splined", Structure::splined},
           {"clamped", Structure::clamped}},
          "traditional: outer surface fixed, or a bolted flange if one is declared; thin_walled: cantilevered from "
          "a sleeve whose end face is fixed, outside free, with a hoop if one is declared; pinned: pins around the "
          "outside that carry outward pressure only; bolted: bolts at the same positions, fixed both ways; "
          "splined: spline teeth around the outside in a rigid mate; clamped: both end faces fixed by a bolt circle "
          "through the rim, outside free.")
      .required();
  declare_teeth(ring, Flanks::internal);
  declare_mass(ring);
  declare_inertia(ring).required_if(given("[dynamics]"));
  declare_flanks(ring, Flanks::internal);
  ring.key("outside_diameter_mm", &RingInput::outside_diameter, "Outside diameter.")
      .above(0, 1e5)
      .absent("root diameter plus twice rim_thickness_mm");
  ring.key("rim_thickness_mm", &RingInput::rim_thickness, "From the root circle to the outside.")
      .above(0, 1e4)
      .instead_of({"outside_diameter_mm"})
      .absent("follows from outside_diameter_mm");
}

void declare_flange(RingDeclarations& ring) {
  const auto traditional = is("structure", {"traditional"});
  ring.key("flange_width_mm", &RingInput::flange_width,
           "Axial width of a toothless flange at the lower end of the ring, fixed by its end face.")
      .above(0, 5000)
      .only_if(traditional)
      .absent("no flange: the outer surface is fixed");
  ring.key("flange_diameter_mm", &RingInput::flange_diameter, "Outside diameter of the flange.")
      .above(0, 1e5)
      .only_if(traditional)
      .together_with("flange_width_mm")
      .absent("no flange: the outer surface is fixed");
}

void declare_sleeve(RingDeclarations& ring) {
  const auto thin_walled = is("structure", {"thin_walled"});
  ring.key("free_length_mm", &RingInput::free_length,
           "Length of the toothless sleeve between the fixed face and the teeth; 0: the teeth start at the fixed face.")
      .from(0, 1e4)
      .needed_if(thin_walled);
  ring.key("sleeve_thickness_mm", &RingInput::sleeve_thickness, "Thickness of the sleeve, at the outside diameter.")
      .above(0, 1e4)
      .needed_if(thin_walled);
  ring.key("hoop_width_mm", &RingInput::hoop_width, "Axial width of a stiffening hoop at the free end.")
      .above(0, 1e4)
      .only_if(thin_walled)
      .absent("no hoop");
  ring.key("hoop_thickness_mm", &RingInput::hoop_thickness,
           "Radial thickness of the hoop, beyond the outside diameter.")
      .above(0, 1e4)
      .only_if(thin_walled)
      .together_with("hoop_width_mm")
      .absent("no hoop");
}

void declare_pins(RingDeclarations& ring) {
  const auto pinned = is("structure", {"pinned", "bolted"});
  ring.key("pins", &RingInput::pins, "Number of equally spaced pins or bolts.")
      .from(1, 2000)
      .only_if(pinned)
      .absent("pin_angles_deg lists them");
  ring.key("pin_angles_deg", &RingInput::pin_angles,
           "Angular position of every pin, counter-clockwise from the centre of tooth 0.")
      .from(-360, 360)
      .longest(2000)
      .only_if(pinned)
      .instead_of({"pins"})
      .absent("equally spaced");
  ring.key("first_pin_angle_deg", &RingInput::first_pin_angle,
           "Angular position of the first of equally spaced pins, from the centre of tooth 0.")
      .from(-360, 360)
      .only_if(pinned)
      .only_if(given("pins"), "pin_angles_deg positions every pin")
      .fallback(0.0, "behind tooth 0");
  ring.key("pin_diameter_mm", &RingInput::pin_diameter, "Diameter of a pin or bolt.").above(0, 1000).needed_if(pinned);
  ring.key("pin_clearance_um", &RingInput::pin_clearance, "Radial play of a pin.")
      .from(0, 1e4)
      .only_if(is("structure", {"pinned"}))
      .fallback(0.0, "no play");
  ring.key("pin_radial_stiffness_N_per_m", &RingInput::pin_radial_stiffness, "Radial stiffness of one pin or bolt.")
      .above(0, 1e14)
      .only_if(pinned)
      .absent("derived from the pin");
  ring.key("pin_tangential_stiffness_N_per_m", &RingInput::pin_tangential_stiffness,
           "Tangential stiffness of one pin or bolt.")
      .above(0, 1e14)
      .only_if(pinned)
      .absent("as the radial one");
  ring.key("pin_free_span_mm", &RingInput::pin_free_span,
           "Length of pin between ring and housing, where it bends and shears.")
      .from(0, 1000)
      .only_if(pinned)
      .fallback(0.0, "no bending of the pin");
  ring.key("housing_clearance_um", &RingInput::housing_clearance,
           "Radial play of the rim in a rigid housing bore, on which it can rest.")
      .from(0, 1e4)
      .only_if(pinned)
      .absent("no bore; 0 with a single pin, which cannot hold the ring alone");
}

void declare_splines(RingDeclarations& ring) {
  const auto splined = is("structure", {"splined"});
  ring.key("splines", &RingInput::splines, "Number of spline teeth around the outside.")
      .from(3, 2000)
      .needed_if(splined);
  ring.key("first_spline_angle_deg", &RingInput::first_spline_angle,
           "Centre of the first spline tooth, from the centre of tooth 0.")
      .from(-360, 360)
      .only_if(splined)
      .fallback(0.0, "behind tooth 0");
  ring.key("spline_flank_angle_deg", &RingInput::spline_flank_angle,
           "Angle between a spline flank and the radius, at the outside diameter.")
      .from(0, 60)
      .only_if(splined)
      .fallback(30.0, "the pressure angle of ISO 4156");
  ring.key("spline_clearance_um", &RingInput::spline_clearance, "Play of each spline flank, normal to it.")
      .from(0, 1e4)
      .only_if(splined)
      .fallback(0.0, "no play");
  ring.key("spline_stiffness_N_per_m", &RingInput::spline_stiffness, "Normal stiffness of one spline flank.")
      .above(0, 1e14)
      .only_if(splined)
      .absent("derived from the spline tooth");
}

void declare_clamp(RingDeclarations& ring) {
  const auto clamped = is("structure", {"clamped"});
  ring.key("clamp_inner_diameter_mm", &RingInput::clamp_inner_diameter,
           "Both end faces are fixed between this diameter and the outside; the rest of them is free.")
      .above(0, 1e5)
      .needed_if(clamped);
  ring.key("bolts", &RingInput::bolts, "Number of equally spaced bolts through the rim.")
      .from(3, 2000)
      .needed_if(clamped);
  ring.key("bolt_circle_diameter_mm", &RingInput::bolt_circle_diameter, "Diameter of the bolt circle.")
      .above(0, 1e5)
      .needed_if(clamped);
  ring.key("bolt_diameter_mm", &RingInput::bolt_diameter, "Diameter of the bolt holes.")
      .above(0, 1000)
      .needed_if(clamped);
  ring.key("first_bolt_angle_deg", &RingInput::first_bolt_angle,
           "Angular position of the first bolt, from the centre of tooth 0.")
      .from(-360, 360)
      .only_if(clamped)
      .fallback(0.0, "behind tooth 0");
  ring.key("dowels", &RingInput::dowels, "Number of dowels on the bolt circle, between bolts.")
      .from(1, 2000)
      .only_if(clamped)
      .absent("no dowels");
  ring.key("dowel_diameter_mm", &RingInput::dowel_diameter, "Diameter of the dowels.")
      .above(0, 1000)
      .only_if(clamped)
      .together_with("dowels")
      .absent("no dowels");
}

}  // namespace

Table ring_table() {
  RingDeclarations ring("ring", "A ring gear and its supports; several rings are compared with each other.",
                        &Scene::rings);
  declare_ring_body(ring);
  declare_flange(ring);
  declare_sleeve(ring);
  declare_pins(ring);
  declare_splines(ring);
  declare_clamp(ring);
  return ring.done();
}

}  // namespace annulus::app
