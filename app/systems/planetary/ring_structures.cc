#include "app/systems/planetary/ring_structures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "app/scene/key_checks.h"
#include "app/scene/model_limits.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/ring_pins.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/planetary/structure_keys.h"
#include "core/errors.h"
#include "core/units.h"
#include "fem/problem/structures/clamped.h"
#include "fem/problem/structures/spline_held.h"
#include "fem/problem/structures/surface_held.h"
#include "geometry/sector_mesh.h"

namespace annulus::app {

namespace {

void declare_flange(Declarations<RingInput>& ring) {
  const StructureKeys keys{ring, is("structure", {"traditional"})};
  keys.optional("flange_width_mm", &RingInput::flange_width,
                "Axial width of a toothless flange at the lower end of the ring, fixed by its end face.")
      .above(0, 5000)
      .absent("no flange: the outer surface is fixed");
  keys.optional("flange_diameter_mm", &RingInput::flange_diameter, "Outside diameter of the flange.")
      .above(0, 1e5)
      .together_with("flange_width_mm")
      .absent("no flange: the outer surface is fixed");
}

void declare_sleeve(Declarations<RingInput>& ring) {
  const StructureKeys keys{ring, is("structure", {"thin_walled"})};
  keys.needed(
          "free_length_mm", &RingInput::free_length,
          "Length of the toothless sleeve between the fixed face and the teeth; 0: the teeth start at the fixed face.")
      .from(0, 1e4);
  keys.optional("sleeve_thickness_mm", &RingInput::sleeve_thickness,
                "Thickness of the sleeve, at the outside diameter.")
      .above(0, 1e4)
      .absent("without a sleeve (free_length_mm = 0), the whole rim is held; else it is required");
  keys.optional("hoop_width_mm", &RingInput::hoop_width, "Axial width of a stiffening hoop at the free end.")
      .above(0, 1e4)
      .absent("no hoop");
  keys.optional("hoop_thickness_mm", &RingInput::hoop_thickness,
                "Radial thickness of the hoop, beyond the outside diameter.")
      .above(0, 1e4)
      .together_with("hoop_width_mm")
      .absent("no hoop");
}

void declare_splines(Declarations<RingInput>& ring) {
  const StructureKeys keys{ring, is("structure", {"splined"})};
  keys.needed("splines", &RingInput::splines, "Number of spline teeth around the outside.").from(3, 2000);
  keys.optional("first_spline_angle_deg", &RingInput::first_spline_angle,
                "Angular position of the first spline tooth, from the centre of tooth 0.")
      .from(-360, 360)
      .fallback(0.0, "behind tooth 0");
  keys.optional("spline_flank_angle_deg", &RingInput::spline_flank_angle,
                "Angle between a spline flank and the radius, at the outside diameter.")
      .from(0, 60)
      .fallback(30.0, "the pressure angle of ISO 4156");
  keys.optional("spline_clearance_um", &RingInput::spline_clearance, "Play of each spline flank, normal to it.")
      .from(0, 1e4)
      .fallback(0.0, "no play");
  keys.optional("spline_stiffness_N_per_m", &RingInput::spline_stiffness, "Normal stiffness of one spline flank.")
      .above(0, 1e14)
      .absent("derived from the spline tooth");
}

void declare_clamp(Declarations<RingInput>& ring) {
  const StructureKeys keys{ring, is("structure", {"clamped"})};
  keys.needed("clamp_inner_diameter_mm", &RingInput::clamp_inner_diameter,
              "Both end faces are fixed between this diameter and the outside; the rest is free.")
      .above(0, 1e5);
  keys.needed("bolts", &RingInput::bolts, "Number of equally spaced bolts through the rim.").from(3, 2000);
  keys.needed("bolt_circle_diameter_mm", &RingInput::bolt_circle_diameter, "Diameter of the bolt circle.")
      .above(0, 1e5);
  keys.needed("bolt_diameter_mm", &RingInput::bolt_diameter, "Diameter of the bolt holes.").above(0, 1000);
  keys.optional("first_bolt_angle_deg", &RingInput::first_bolt_angle,
                "Angular position of the first bolt, from the centre of tooth 0.")
      .from(-360, 360)
      .fallback(0.0, "behind tooth 0");
  keys.optional("dowels", &RingInput::dowels, "Number of dowels on the bolt circle, between bolts.")
      .from(1, 2000)
      .absent("no dowels");
  keys.optional("dowel_diameter_mm", &RingInput::dowel_diameter, "Diameter of the dowels.")
      .above(0, 1000)
      .together_with("dowels")
      .absent("no dowels");
}

class RingChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void check(RingInput& ring) {
    if (!usable("ring.structure", ring.name)) return;
    if (ring.structure == Structure::traditional) check_flange(ring);
    if (ring.structure == Structure::thin_walled) check_sleeve(ring);
    if (ring.has_pins()) check_pins(ring, scene_, problems_);
    if (ring.structure == Structure::clamped) check_clamp(ring);
  }

 private:
  void check_sleeve(RingInput& ring) {
    not_wider_than_face("ring.hoop_width_mm", ring, ring.hoop_width);
    const std::string key = "ring.sleeve_thickness_mm";
    if (given(key, ring.name) || !usable("ring.free_length_mm", ring.name)) return;
    if (ring.free_length.value_or(0) > 0)
      return problem(key, ring.name, "is required by structure = \"thin_walled\" with free_length_mm > 0");
    const auto outside = known_outside(scene_, ring);
    if (!outside) return;  // refused with its reason where the ring is made
    const double root = make_gear(scene_, ring, geometry::GearKind::internal).root_radius();
    ring.sleeve_thickness = *outside - root - least_rim(scene_);
    set(key, *ring.sleeve_thickness / units::mm, Origin::derived, "no sleeve: the whole rim is held", ring.name);
  }

  void check_flange(const RingInput& ring) {
    not_wider_than_face("ring.flange_width_mm", ring, ring.flange_width);
    if (const auto radius = known_outside(scene_, ring);
        radius && ring.flange_diameter && *ring.flange_diameter <= 2 * *radius) {
      problem(
          "ring.flange_diameter_mm", ring.name,
          fmt::format("must be larger than the outside diameter, value > {} mm", to_text(2 * *radius / units::mm, 7)));
    }
  }

  void check_clamp(const RingInput& ring) {
    const auto radius = known_outside(scene_, ring);
    if (radius && ring.clamp_inner_diameter && *ring.clamp_inner_diameter >= 2 * *radius)
      return problem(
          "ring.clamp_inner_diameter_mm", ring.name,
          fmt::format("must be smaller than the outside diameter, value < {} mm", to_text(2 * *radius / units::mm, 7)));
    if (ring.clamp_inner_diameter && ring.bolt_circle_diameter && ring.bolt_diameter && ring.bolts) bolt_circle(ring);
  }

  /// Bolts and dowels lie in the clamped annulus and leave each other room.
  void bolt_circle(const RingInput& ring) {
    const double circle = *ring.bolt_circle_diameter, bolt = *ring.bolt_diameter;
    const double widest = std::max(bolt, ring.dowel_diameter.value_or(0));
    const auto mm = [](double length) { return to_text(length / units::mm, 7); };
    const auto radius = known_outside(scene_, ring);
    const double least = *ring.clamp_inner_diameter + widest;
    if (circle < least || (radius && circle > 2 * *radius - widest))
      problem("ring.bolt_circle_diameter_mm", ring.name,
              fmt::format("bolts and dowels of up to {} mm have to lie in the clamped end faces: {} mm <= value{}",
                          mm(widest), mm(least), radius ? fmt::format(" <= {} mm", mm(2 * *radius - widest)) : ""));
    const double apart = circle * std::sin(std::numbers::pi / *ring.bolts);
    if (apart < bolt)
      problem(
          "ring.bolts", ring.name,
          fmt::format("bolts overlap: their centres are {} mm apart on the bolt circle, less than bolt_diameter_mm = "
                      "{}",
                      to_text(apart / units::mm, 4), mm(bolt)));
    if (!ring.dowels || !ring.dowel_diameter) return;
    if (*ring.dowels > *ring.bolts)
      problem("ring.dowels", ring.name,
              fmt::format("there is room for one dowel between two bolts, value <= bolts = {}", *ring.bolts));
    const double beside = circle * std::sin(std::numbers::pi / 2 / *ring.bolts);
    if (apart >= bolt && beside < (bolt + *ring.dowel_diameter) / 2)
      problem("ring.dowel_diameter_mm", ring.name,
              fmt::format("dowels overlap the bolts, whose centres are {} mm away: value <= {} mm",
                          to_text(beside / units::mm, 4), mm(2 * beside - bolt)));
  }

  void not_wider_than_face(const std::string& key, const RingInput& ring, const std::optional<double>& width) {
    const double face = face_width_of(scene_, ring);
    if (!width || !usable("stage.face_width_mm") || *width <= face) return;
    problem(key, ring.name, fmt::format("must not exceed the face width, value <= {} mm", to_text(face / units::mm)));
  }
};

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

void declare_structure(Declarations<RingInput>& ring) {
  ring.choice("structure", &RingInput::structure,
              {{"traditional", Structure::traditional},
               {"thin_walled", Structure::thin_walled},
               {"pinned", Structure::pinned},
               {"bolted", Structure::bolted},
               {"splined", Structure::splined},
               {"clamped", Structure::clamped}},
              "traditional: the outer surface is fixed, or a bolted flange if one is declared. thin_walled: "
              "cantilevered from a sleeve with a fixed end face; the outside is free; with a hoop if one is declared. "
              "pinned: pins around the outside that carry outward pressure only. bolted: bolts at the same positions "
              "that hold in both directions. splined: spline teeth around the outside in a rigid mate. clamped: both "
              "end faces are fixed by a bolt circle through the rim; the outside is free.")
      .required();
}

void declare_structure_keys(Declarations<RingInput>& ring) {
  declare_flange(ring);
  declare_sleeve(ring);
  declare_pins({ring, is("structure", {"pinned", "bolted"})});
  declare_splines(ring);
  declare_clamp(ring);
}

void check_structure(RingInput& ring, Scene& scene, std::vector<Problem>& problems) {
  RingChecker(scene, problems).check(ring);
}

void check_structure_in_rim(const Scene& scene, const RingInput& input, const RingGeometry& ring) {
  const auto refuse = [&](const char* key, double value, const std::string& rule) {
    throw GeometryError(fmt::format("ring '{}': {} = {}: {}", input.name, key, to_text(value / units::mm), rule));
  };
  const double root = ring.set.ring().root_radius(), rim = ring.outside_radius - root, least = least_rim(scene);
  if (input.sleeve_thickness && *input.sleeve_thickness > (rim - least) * (1 + diameter_rounding))
    refuse("sleeve_thickness_mm", *input.sleeve_thickness,
           fmt::format("must be in range: 0 < value <= {}: the sleeve lies in the rim, which is {} thick, and must be "
                       "{} = {} modules away from the root",
                       length_mm(rim - least), length_mm(rim), length_mm(least), geometry::min_circle_distance));
  const double smallest = 2 * (root + least), largest = 2 * (ring.outside_radius - least);
  if (input.clamp_inner_diameter && (*input.clamp_inner_diameter < smallest * (1 - diameter_rounding) ||
                                     *input.clamp_inner_diameter > largest * (1 + diameter_rounding)))
    refuse("clamp_inner_diameter_mm", *input.clamp_inner_diameter,
           fmt::format("must be in range: {} <= value <= {}: the clamped end faces lie in the rim, and their edge must "
                       "be {} = {} modules away from root and outside",
                       length_mm(smallest), length_mm(largest), length_mm(least), geometry::min_circle_distance));
}

fem::RingStructure ring_structure(const RingInput& ring) {
  switch (ring.structure) {
    case Structure::traditional:
      return traditional(ring);
    case Structure::thin_walled:
      return thin_walled(ring);
    case Structure::pinned:
      return on_pins(ring, PinContact::unilateral);
    case Structure::bolted:
      return on_pins(ring, PinContact::both_ways);
    case Structure::splined:
      return splined(ring);
    case Structure::clamped:
      break;
  }
  return clamped(ring);
}

void mirror_structure(RingInput& ring) {
  for (double& angle : ring.pin_angles) angle = -angle;
  for (auto* first : {&ring.first_pin_angle, &ring.first_spline_angle, &ring.first_bolt_angle})
    if (*first) **first = -**first;
}

}  // namespace annulus::app
