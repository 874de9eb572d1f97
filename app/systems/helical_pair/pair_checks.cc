#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scene/key_checks.h"
#include "app/scene/model_limits.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/pair_model.h"
#include "app/systems/helical_pair/pair_scene.h"
#include "app/systems/helical_pair/pair_space.h"
#include "app/systems/helical_pair/pair_stiffness.h"
#include "app/systems/shared/profile_shifts.h"
#include "app/systems/shared/rotors.h"
#include "app/systems/shared/space_tables.h"
#include "core/units.h"

namespace annulus::app {

namespace {

class PairChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    stiffness();
    errors();
    dynamics();
    check_rotors(scene_, problems_, dynamics::HelicalPair().shaft_ends());
    space();
    // What follows needs values that are all there.
    if (problems_.empty()) geometry();
  }

 private:
  void stiffness() {
    if (!usable("mesh.pinion_wheel.stiffness") && given("mesh.pinion_wheel.stiffness")) return;
    const auto& m = helical_pair(scene_).pinion_wheel;
    using Shape = StiffnessShape;
    wave(m, "mesh.pinion_wheel", {Shape::harmonic, Shape::iso_6336});
    const bool tabulated =
        m.stiffness == Shape::computed || m.stiffness == Shape::closed_form || m.stiffness == Shape::table;
    if (tabulated && usable("stage.pinion_torque_Nm") && helical_pair(scene_).stage.pinion_torque <= 0)
      problem("stage.pinion_torque_Nm",
              "must be above 0 with a tabulated stiffness (computed, closed_form or table): the table is for loaded "
              "driving flanks");
  }

  void errors() {
    if (!helical_pair(scene_).manufacturing_error) return;
    const auto& m = *helical_pair(scene_).manufacturing_error;
    // Its value is drawn in the run.
    if (m.reading != "none") set("errors.mesh_error_um", {}, Origin::derived, "the reading of [manufacturing_error]");
    const std::string table = "manufacturing_error.";
    const auto order = [&](const std::string& gear, double total, double tooth) {
      if (!usable(table + gear + "_total_um") || !usable(table + gear + "_tooth_to_tooth_um")) return;
      if (tooth > total)
        problem(table + gear + "_tooth_to_tooth_um",
                fmt::format("must not exceed {}_total_um, value <= {} µm: a turn contains every pitch", gear,
                            to_text(total / units::um)));
      if (total == 0)
        problem(table + gear + "_total_um", "must be above 0: without deviations there is no distribution");
    };
    order("pinion", m.pinion_total, m.pinion_tooth_to_tooth);
    order("wheel", m.wheel_total, m.wheel_tooth_to_tooth);
    if (usable(table + "probability") && usable(table + "samples")) {
      // Fewer draws than this leave the quantile without a single one beyond it.
      const double least = 1 / std::min(m.probability, 1 - m.probability);
      if (m.samples < least)
        problem(table + "samples", fmt::format("are too few for the quantile at {}: value >= {}",
                                               to_text(m.probability), std::ceil(least)));
    }
  }

  void space() {
    check_space(scene_, problems_);
    if (pair_in_space(scene_) && usable("stage.pinion_torque_Nm") && helical_pair(scene_).stage.pinion_torque <= 0)
      problem(
          "stage.pinion_torque_Nm",
          "must be above 0 with [[bearing]], [[load]] or [gravity]: gears that tilt have driving flanks alone. Of a "
          "pinion that is driven the mirror image is meant, with helix_angle_deg of the other sign");
  }

  void dynamics() {
    if (!scene_.dynamics) return;
    const auto& e = helical_pair(scene_).errors;
    const bool no_error =
        e.mesh_error.value_or(0) == 0 && e.pinion_error == 0 && e.wheel_error == 0 &&
        (!helical_pair(scene_).manufacturing_error || helical_pair(scene_).manufacturing_error->reading == "none");
    const bool no_ripple = std::all_of(scene_.rotors.begin(), scene_.rotors.end(), [](const RotorInput& rotor) {
      return rotor.ripple_orders.empty() && rotor.torque_over_turn.empty();
    });
    if (usable("stage.pinion_torque_Nm") && helical_pair(scene_).stage.pinion_torque == 0 && no_error && no_ripple)
      problem("stage.pinion_torque_Nm",
              "must not be 0 without errors and torques of rotors that change: nothing excites the pair");
  }

  /// Derived inputs, and checks that need the geometry of the gears.
  void geometry() {
    resolve_profile_shifts(
        scene_, problems_,
        {{"pinion", &helical_pair(scene_).pinion, geometry::GearKind::external, &helical_pair(scene_).wheel, "wheel"},
         {"wheel", &helical_pair(scene_).wheel, geometry::GearKind::external, &helical_pair(scene_).pinion, "pinion"}});
    for (const auto& [name, gear] :
         {std::pair{"pinion", &helical_pair(scene_).pinion}, {"wheel", &helical_pair(scene_).wheel}}) {
      const auto inertia = pair_inertia(scene_, *gear);
      if (!given(std::string(name) + ".inertia_kg_m2") && inertia)
        set(std::string(name) + ".inertia_kg_m2", *inertia, Origin::derived,
            "½ m r² of a solid disc, r: reference circle");
    }
    std::optional<PairGeometry> pair;
    try {
      pair = make_pair_geometry(scene_);
    } catch (const GeometryError&) {
      return;  // reported with its reason where the gears are made
    }
    if (!given("stage.centre_distance_mm"))
      set("stage.centre_distance_mm", pair->gears.centre_distance() / units::mm, Origin::derived,
          "no backlash at the profile shifts");
    for (const auto& [name, gear, input] : {std::tuple{"pinion", &pair->pinion(), &helical_pair(scene_).pinion},
                                            {"wheel", &pair->wheel(), &helical_pair(scene_).wheel}}) {
      if (input->bore_diameter && *input->bore_diameter >= 2 * gear->root_radius())
        problem(std::string(name) + ".bore_diameter_mm",
                fmt::format("must be smaller than the root diameter, value < {} mm",
                            to_text(2 * gear->root_radius() / units::mm, 7)));
    }
    if (pair->gears.contact_ratio() < 1 && helical_pair(scene_).pinion_wheel.stiffness == StiffnessShape::iso_6336)
      problem("mesh.pinion_wheel.stiffness", fmt::format("needs a transverse contact ratio of 1 at least; it is {}",
                                                         to_text(pair->gears.contact_ratio(), 4)));
    if (helical_pair(scene_).pinion_wheel.stiffness == StiffnessShape::closed_form) {
      if (const auto why = no_closed_form(scene_, *pair); !why.empty())
        problem("mesh.pinion_wheel.stiffness", "is not possible: " + why + "; use \"computed\"");
    }
    if (helical_pair(scene_).pinion_wheel.stiffness != StiffnessShape::computed) return;
    const auto solid = pair_solid_reason(scene_, *pair);
    if (scene_.fidelity == Fidelity::resolved && scene_.stage.helix_angle != 0)
      problem("model", "cannot represent helical gears: use \"automatic\" or \"solid\"");
    if ((scene_.fidelity == Fidelity::plane || scene_.fidelity == Fidelity::closed_form) && !solid.empty())
      problem("model", fmt::format("cannot represent the mesh: {}; use \"automatic\" or \"solid\"{}", solid,
                                   scene_.fidelity == Fidelity::closed_form
                                       ? ", or stiffness = \"closed_form\" in [mesh.pinion_wheel]"
                                       : ""));
  }
};

}  // namespace

void check_pair_scene(Scene& scene, std::vector<Problem>& problems) { PairChecker(scene, problems).run(); }

void check_pair_geometry(const Scene& scene, const PairGeometry& geometry) {
  const auto stiffness = helical_pair(scene).pinion_wheel.stiffness;
  const bool elastic = stiffness == StiffnessShape::computed || stiffness == StiffnessShape::closed_form;
  if (elastic) {
    check_bore(scene, "pinion", helical_pair(scene).pinion, geometry.pinion());
    check_bore(scene, "wheel", helical_pair(scene).wheel, geometry.wheel());
  }
  constexpr const char* load = "stage.pinion_torque_Nm";
  if (scene.dynamics) {
    check_deviations(scene);
    const double across = geometry.transverse_force, along = across * std::tan(std::abs(scene.stage.helix_angle));
    check_prescribed_mesh(scene, load, helical_pair(scene).pinion_wheel, across);
    check_bearing(scene, "pinion.bearing_transverse_N_per_m", helical_pair(scene).pinion.bearing_transverse, across);
    check_bearing(scene, "wheel.bearing_transverse_N_per_m", helical_pair(scene).wheel.bearing_transverse, across);
    check_bearing(scene, "pinion.bearing_axial_N_per_m", helical_pair(scene).pinion.bearing_axial, along);
    check_bearing(scene, "wheel.bearing_axial_N_per_m", helical_pair(scene).wheel.bearing_axial, along);
  }
  if (elastic)
    check_load(scene, load, geometry.transverse_force, geometry.gears.common_face().width,
               fem::MeshMaterials(material_of(scene, helical_pair(scene).pinion),
                                  material_of(scene, helical_pair(scene).wheel))
                   .youngs_modulus());
}

}  // namespace annulus::app
