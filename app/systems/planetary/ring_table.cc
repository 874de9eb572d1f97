#include "app/scene/gear_tables.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_scene.h"
#include "app/systems/planetary/ring_structures.h"

namespace annulus::app {

namespace {

void declare_ring_body(Declarations<RingInput>& ring) {
  ring.key("name", &RingInput::name, "Name of the ring and of the folder of its results.").required();
  declare_structure(ring);
  declare_teeth(ring, Flanks::internal, "planet");
  declare_mass(ring).required_if(given("[gravity]"), "all bodies have a weight");
  declare_inertia(ring).required_if(given("[dynamics]"));
  declare_own_face(ring);
  declare_own_material(ring);
  declare_flanks(ring, Flanks::internal);
  ring.key("outside_diameter_mm", &RingInput::outside_diameter, "Outside diameter.")
      .above(0, 1e5)
      .absent("root diameter plus twice rim_thickness_mm");
  ring.key("rim_thickness_mm", &RingInput::rim_thickness, "Thickness from the root circle to the outside.")
      .above(0, 1e4)
      .instead_of({"outside_diameter_mm"})
      .absent("follows from outside_diameter_mm");
}

}  // namespace

Table ring_table() {
  Declarations<RingInput> ring("ring", "A ring gear and its supports; several rings are compared with each other.",
                               &PlanetaryInput::rings);
  ring.variants();
  declare_ring_body(ring);
  declare_structure_keys(ring);
  return ring.done();
}

}  // namespace annulus::app
