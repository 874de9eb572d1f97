#pragma once

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene_declare.h"

/// Keys that several kinds of gear systems have, for their tables.
namespace annulus::app {

enum class Flanks { external, internal };

/// profile_shift_from and what it needs; for kinds that resolve it (systems/shared/profile_shifts.h).
template <class Section>
void declare_shift_sources(Declarations<Section>& t, Flanks flanks, const char* mate) {
  const bool internal = flanks == Flanks::internal;
  t.choice("profile_shift_from", &Section::shift_from,
           {{"centre_distance", ShiftSource::centre_distance},
            {"tip_diameter", ShiftSource::tip_diameter},
            {"root_diameter", ShiftSource::root_diameter},
            {"span", ShiftSource::span},
            {"pins", ShiftSource::pins}},
           std::string("What the profile shift follows from, instead of profile_shift. centre_distance: it and the "
                       "shift of the ") +
               mate +
               ", with the backlash of normal_backlash_um. tip_diameter, root_diameter: these and an addendum of one "
               "module or a dedendum of 1.25 modules. span, pins: the measured dimension.")
      .instead_of({"profile_shift"})
      .absent("profile_shift states it");
  const auto from = [](const char* source) { return is("profile_shift_from", {source}); };
  t.key("normal_backlash_um", &Section::normal_backlash,
        std::string("Backlash, normal to the flanks, that the profile shift leaves in mesh with the ") + mate + ".")
      .from(0, 1e4)
      .only_if(from("centre_distance"))
      .fallback(0.0, "no backlash");
  t.key("span_mm", &Section::span,
        internal ? "Base tangent length over span_teeth spaces." : "Base tangent length over span_teeth teeth.")
      .above(0, 1e5)
      .needed_if(from("span"));
  t.key("span_teeth", &Section::span_teeth, internal ? "Spaces of span_mm." : "Teeth of span_mm.")
      .from(1, 1000)
      .needed_if(from("span"));
  t.key("over_pins_mm", &Section::over_pins,
        internal ? "Dimension between two pins (balls for helical teeth) of measuring_pin_mm in opposite spaces."
                 : "Dimension over two pins (balls for helical teeth) of measuring_pin_mm in opposite spaces.")
      .above(0, 1e5)
      .needed_if(from("pins"));
  t.key("measuring_pin_mm", &Section::measuring_pin, "Diameter of the pins of over_pins_mm.")
      .above(0, 1e4)
      .needed_if(from("pins"));
}

inline constexpr double least_shift = -2, largest_shift = 3;  // modules

/// teeth, profile_shift; `mate`: of a gear whose shift may follow from a drawing, with the keys for that.
template <class Section>
void declare_teeth(Declarations<Section>& t, Flanks flanks, const char* mate = nullptr) {
  t.key("teeth", &Section::teeth, "Number of teeth.").required().from(5, 2000);
  auto shift = t.key("profile_shift", &Section::profile_shift,
                     flanks == Flanks::internal ? "Profile shift in modules; positive moves the tooth space outwards."
                                                : "Profile shift in modules; positive moves the rack outwards.");
  shift.from(least_shift, largest_shift);
  if (mate == nullptr) {
    shift.required();
    return;
  }
  shift.absent("follows from profile_shift_from");
  declare_shift_sources(t, flanks, mate);
}

/// youngs_modulus_GPa, poisson_ratio and density_kg_per_m3 of a gear that is not made of [material].
template <class Section>
void declare_own_material(Declarations<Section>& t) {
  const char* common = "that of [material]";
  t.key("youngs_modulus_GPa", &Section::youngs_modulus, "Young's modulus of this gear.")
      .from(1e-6, 2000)
      .absent(common);
  t.key("poisson_ratio", &Section::poisson_ratio, "Poisson's ratio of this gear.").from(0, 0.4999).absent(common);
  t.key("density_kg_per_m3", &Section::density, "Density of this gear.").from(100, 30000).absent(common);
}

/// face_width_mm and axial_offset_mm of a gear.
template <class Section>
void declare_own_face(Declarations<Section>& t) {
  t.key("face_width_mm", &Section::face_width,
        "Face width of this gear. Flanks touch where both gears of a mesh have teeth.")
      .above(0, 5000)
      .absent("that of [stage]");
  t.key("axial_offset_mm", &Section::axial_offset,
        "Middle of this gear's face along the axis (z) against that of the stage.")
      .from(-5000, 5000)
      .fallback(0.0, "the middles of all faces are in one plane");
}

/// mass_kg
template <class Section>
Declared declare_mass(Declarations<Section>& t, const char* meaning = "Mass.") {
  Declared key = t.key("mass_kg", &Section::mass, meaning);
  key.from(lightest_kg, 1e6).required_if(given("[dynamics]"));
  return key;
}

/// inertia_kg_m2
template <class Section>
Declared declare_inertia(Declarations<Section>& t, const char* meaning = "Moment of inertia about the axis.") {
  Declared key = t.key("inertia_kg_m2", &Section::inertia, meaning);
  key.from(least_inertia_kg_m2, 1e6);
  return key;
}

/// The measured flank in a file that a scene names. Throws InputError for what is no such file, and for models without
/// measured flanks.
[[nodiscard]] std::shared_ptr<const geometry::FlankTopography> measured_flank(const Scene& scene,
                                                                              const std::string& file);

/// From tip_diameter_mm to right_topography.
template <class Section>
void declare_flanks(Declarations<Section>& t, Flanks flanks) {
  t.key("tip_diameter_mm", &Section::tip_diameter, "Tip diameter.")
      .above(0, 1e5)
      .absent("addendum of one module beyond the profile shift (ISO 53)");
  t.key("root_diameter_mm", &Section::root_diameter, "Root diameter.")
      .above(0, 1e5)
      .absent("dedendum of 1.25 modules beyond the profile shift (ISO 53)");
  t.key("root_fillet_factor", &Section::root_fillet_factor,
        flanks == Flanks::internal
            ? "Radius of the root fillet in modules; limited to the full circle between the flanks."
            : "Tip radius of the generating rack in modules.")
      .fallback(0.38, "ISO 53 profile A")
      .above(0, 0.6);
  if (flanks == Flanks::external) {
    t.key("protuberance_um", &Section::protuberance,
          "Protuberance of the tool beyond the finished flank: p_r less the machining allowance (s_pr of ISO 6336-3). "
          "It "
          "leaves an undercut in the root, without which grinding would leave a notch.")
        .fallback(0.0, "a rack without protuberance")
        .from(0, 5000);
    t.key("protuberance_angle_deg", &Section::protuberance_angle,
          "Pressure angle of the tool between its tip and its main flank.")
        .from(2, 34)
        .only_if(given("protuberance_um"))
        .absent("half of stage.pressure_angle_deg, as usual hobs");
  }
  t.key("tip_chamfer_mm", &Section::tip_chamfer,
        "Radial height of the chamfers between flanks and tip circle, at 45 degrees. The flanks end where they begin.")
      .fallback(0.0, "sharp tips")
      .from(0, 100);
  const auto modification = [&](const char* name, double Section::*member, const char* meaning) {
    return t.key(name, member, meaning).fallback(0.0, "unmodified flanks");
  };
  modification("tip_relief_um", &Section::tip_relief, "Linear tip relief, normal to the flank.").from(0, 1000);
  modification("tip_relief_length_mm", &Section::tip_relief_length,
               "Length of the tip relief along the line of action.")
      .from(0, 1000);
  modification("profile_crowning_um", &Section::profile_crowning,
               "Parabolic crowning at both ends of the flank's profile.")
      .from(0, 1000);
  modification("profile_slope_um", &Section::profile_slope,
               "Slope along the profile from the form circle to the end of the flank at the tip; positive removes "
               "material at the tip, negative at the root.")
      .from(-1000, 1000);
  modification("lead_crowning_um", &Section::lead_crowning,
               "Parabolic crowning along the face width, removed at both ends. The mesh then needs the solid model.")
      .from(0, 1000);
  modification("lead_slope_um", &Section::lead_slope,
               "Slope along the face width, end to end; positive removes material towards +z, the free end of a "
               "thin_walled ring. The mesh then needs the solid model.")
      .from(-1000, 1000);
  using Flank = std::shared_ptr<const geometry::FlankTopography>;
  const auto topography = [&](const std::string& side, std::optional<std::string> GearInput::*file,
                              Flank GearInput::*flank, const char* direction) {
    t.key(side + "_topography", file,
          fmt::format("File (CSV) with the measured {} flank of a tooth, that on the {} side as seen from +z: "
                      "diameter_mm, position_mm, removed_um on a grid (docs/exchange.md). The path is relative to the "
                      "scene. Added to the modifications. Flanks that change along the face need the solid model.",
                      side, direction))
        .absent("involutes, with the modifications above");
    t.then([file, flank](const Scene& scene, Section& gear) { gear.*flank = measured_flank(scene, *(gear.*file)); });
  };
  topography("left", &GearInput::left_topography, &GearInput::leading_flank, "counter-clockwise");
  topography("right", &GearInput::right_topography, &GearInput::trailing_flank, "clockwise");
}

/// bore_diameter_mm, required where a mesh of this gear is computed.
template <class Section>
void declare_bore(Declarations<Section>& t, const Condition& computed) {
  t.key("bore_diameter_mm", &Section::bore_diameter,
        "Diameter of the bore, where the body ends: at a rigid hub, or at the rollers of a planet.")
      .above(0, 1e5)
      .required_if(computed, "a computed body ends at its bore; or prescribe the stiffness of the mesh");
}

/// centre_distance_mm of [stage].
[[nodiscard]] Declared declare_centre_distance(Declarations<StageInput>& stage);
/// tip_shortening of [stage].
void declare_tip_shortening(Declarations<StageInput>& stage);
/// planets of [stage].
void declare_planets(Declarations<StageInput>& stage);

/// Keys of one [mesh.NAME] beside those of all.
struct MeshKeys {
  std::vector<Choice<StiffnessShape>> more_shapes{};  ///< besides computed and the prescribed ones
  std::vector<std::string> more_waves{};              ///< of these shapes, those that may have a ripple and a phase
  const char* constant_shape = "";                    ///< what a shape of `more_waves` is without a ripple
};
[[nodiscard]] Declarations<MeshInput> declare_mesh(Declarations<MeshInput> mesh, const MeshKeys& keys = {});

}  // namespace annulus::app
