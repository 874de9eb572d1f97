#include "app/scene/pair_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/pair/pair_errors.h"
#include "app/pair/pair_model.h"
#include "app/pair/pair_stiffness.h"
#include "app/scene/key_checks.h"
#include "app/scene/scene_schema.h"
#include "core/units.h"

namespace annulus::app {

namespace {

class PairChecker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    stiffness();
    errors();
    transmission_error();
    dynamics();
    // What follows needs values that are all there.
    if (problems_.empty()) geometry();
  }

 private:
  void problem(const std::string& key, const std::string& rule) { KeyChecks::problem(key, "", rule); }

  void stiffness() {
    const std::string table = "mesh.pinion_wheel.";
    if (given(table + "stiffness") && !usable(table + "stiffness")) return;
    const auto& m = scene_.pinion_wheel;
    using Shape = StiffnessShape;
    const auto is = [&](std::initializer_list<Shape> shapes) {
      return std::find(shapes.begin(), shapes.end(), m.stiffness) != shapes.end();
    };
    const auto goes_with = [&](const char* key, bool needed, bool allowed, const char* shapes) {
      const bool there = given(table + key);
      if (needed && !there) problem(table + key, std::string("is required by stiffness = ") + shapes);
      if (!allowed && there) problem(table + key, std::string("has a meaning only with stiffness = ") + shapes);
    };
    const bool wave = is({Shape::harmonic, Shape::rectangular}), iso = is({Shape::iso_6336});
    const bool mean = wave || is({Shape::constant});
    goes_with("mean_N_per_m", mean, mean, "\"constant\", \"harmonic\" or \"rectangular\"");
    goes_with("ripple", wave, wave || iso, "\"harmonic\", \"rectangular\" or \"iso_6336\"");
    goes_with("duty", is({Shape::rectangular}), is({Shape::rectangular}), "\"rectangular\"");
    goes_with("file", is({Shape::table}), is({Shape::table}), "\"table\"");
    goes_with("phase", false, wave || iso, "\"harmonic\", \"rectangular\" or \"iso_6336\"");
    goes_with("single_stiffness_GPa", false, iso, "\"iso_6336\"");
    if (is({Shape::harmonic, Shape::iso_6336}) && m.ripple && *m.ripple >= 1)
      problem(table + "ripple", "must stay below 1: the stiffness would become negative");
    if (is({Shape::rectangular}) && m.ripple && m.duty && *m.ripple * *m.duty >= 1)
      problem(table + "ripple", "times duty must stay below 1: the stiffness would become negative");

    if (scene_.errors.pinion_wheel_misalignment != 0 && !is({Shape::computed}))
      problem(
          "errors.pinion_wheel_misalignment_um",
          "has a meaning only with stiffness = \"computed\" in [mesh.pinion_wheel]: a given stiffness knows nothing of "
          "the face width");
    const bool tabulated = is({Shape::computed, Shape::closed_form, Shape::table});
    if (is({Shape::computed, Shape::closed_form})) {
      for (const auto* key : {"pinion.bore_diameter_mm", "wheel.bore_diameter_mm"}) {
        if (!given(key)) problem(key, "is required because the mesh is computed");
      }
    }
    if (tabulated && usable("stage.pinion_torque_Nm") && scene_.stage.pinion_torque <= 0)
      problem(
          "stage.pinion_torque_Nm",
          "must be above 0 with a tabulated stiffness (computed, closed_form or table): it holds for loaded driving "
          "flanks");
  }

  void errors() {
    if (!scene_.manufacturing_error) return;
    const auto& m = *scene_.manufacturing_error;
    const std::string table = "manufacturing_error.";
    const auto order = [&](const std::string& gear, double total, double tooth) {
      if (!usable(table + gear + "_total_um") || !usable(table + gear + "_tooth_to_tooth_um")) return;
      if (tooth > total)
        problem(table + gear + "_tooth_to_tooth_um",
                fmt::format("must not exceed {}_total_um, value <= {} µm: a turn contains every pitch", gear,
                            to_text(total / units::um)));
      if (total == 0) problem(table + gear + "_total_um", "must be above 0: without deviations there is no law");
    };
    order("pinion", m.pinion_total, m.pinion_tooth_to_tooth);
    order("wheel", m.wheel_total, m.wheel_tooth_to_tooth);
    if (usable(table + "reading")) {
      std::vector<std::string> names = {"none"};
      for (const std::string gear : {"pinion_", "wheel_"}) {
        for (const auto* what : {"error", "error_magnitude", "x1", "x2", "envelope", "crest"})
          names.push_back(gear + what);
      }
      names.insert(names.end(), {"sum", "sum_magnitude"});
      if (std::find(names.begin(), names.end(), m.reading) == names.end()) {
        const std::string near = nearest(m.reading, names);
        std::string all;
        for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
        problem(table + "reading", near.empty() ? "must be one of " + all : "did you mean \"" + near + "\"?");
      } else if (m.reading != "none" && given("errors.mesh_error_um")) {
        problem("errors.mesh_error_um",
                fmt::format("the error at mesh frequency follows from [manufacturing_error] (reading {}); leave one "
                            "out, or set manufacturing_error.reading = \"none\"",
                            m.reading));
      }
    }
    if (usable(table + "probability") && usable(table + "samples")) {
      // Fewer draws than this leave the quantile without a single one beyond it.
      const double least = 1 / std::min(m.probability, 1 - m.probability);
      if (m.samples < least)
        problem(table + "samples", fmt::format("are too few for the quantile at {}: value >= {}",
                                               to_text(m.probability), std::ceil(least)));
    }
  }

  void transmission_error() {
    if (!scene_.transmission_error) return;
    const char* key = "transmission_error.pinion_torques_Nm";
    if (!scene_.dynamics) return problem(key, "needs [dynamics]: the shares are those of the lumped model");
    if (!usable(key)) return;
    const auto& t = *scene_.transmission_error;
    if (t.pinion_torques.empty()) problem(key, "needs at least one torque");
    for (const auto& [name, list] :
         {std::pair{key, &t.pinion_torques}, {"transmission_error.pinion_speeds_rpm", &t.pinion_speeds}}) {
      if (std::set<double>(list->begin(), list->end()).size() != list->size())
        problem(name, "the same value stands there twice");
    }
  }

  void dynamics() {
    if (!scene_.dynamics) return;
    for (const auto* key : {"pinion.mass_kg", "wheel.mass_kg"}) {
      if (!given(key)) problem(key, "is required by [dynamics]");
    }
    integrator();
    const auto& e = scene_.errors;
    const bool no_error = e.mesh_error.value_or(0) == 0 && e.pinion_error == 0 && e.wheel_error == 0 &&
                          (!scene_.manufacturing_error || scene_.manufacturing_error->reading == "none");
    if (usable("stage.pinion_torque_Nm") && scene_.stage.pinion_torque == 0 && no_error)
      problem("stage.pinion_torque_Nm", "must not be 0 without errors: nothing moves the pair");
  }

  /// Derived inputs, and what only the gears themselves tell.
  void geometry() {
    for (const auto& [name, gear] : {std::pair{"pinion", &scene_.pinion}, {"wheel", &scene_.wheel}}) {
      const auto inertia = pair_inertia(scene_, *gear);
      if (!given(std::string(name) + ".inertia_kg_m2") && inertia)
        derive(std::string(name) + ".inertia_kg_m2", *inertia, "½ m r² of a solid disc, r: reference circle");
    }
    std::optional<PairGeometry> pair;
    try {
      pair = make_pair_geometry(scene_);
    } catch (const GeometryError&) {
      return;  // told with its reason where the gears are made
    }
    if (!given("stage.centre_distance_mm"))
      derive("stage.centre_distance_mm", pair->gears.centre_distance() / units::mm,
             "no backlash at the profile shifts");
    for (const auto& [name, gear, input] :
         {std::tuple{"pinion", &pair->pinion(), &scene_.pinion}, {"wheel", &pair->wheel(), &scene_.wheel}}) {
      if (input->bore_diameter && *input->bore_diameter >= 2 * gear->root_radius())
        problem(std::string(name) + ".bore_diameter_mm",
                fmt::format("must be smaller than the root diameter, value < {} mm",
                            to_text(2 * gear->root_radius() / units::mm, 7)));
    }
    if (pair->gears.contact_ratio() < 1 && scene_.pinion_wheel.stiffness == StiffnessShape::iso_6336)
      problem("mesh.pinion_wheel.stiffness", fmt::format("needs a transverse contact ratio of 1 at least; it is {}",
                                                         to_text(pair->gears.contact_ratio(), 4)));
    if (scene_.pinion_wheel.stiffness == StiffnessShape::closed_form) {
      if (const auto why = no_closed_form(scene_); !why.empty())
        problem("mesh.pinion_wheel.stiffness", "is not possible: " + why + "; use \"computed\"");
    }
    if (scene_.pinion_wheel.stiffness != StiffnessShape::computed) return;
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

void complete_and_check_pair(Scene& scene, std::vector<Problem>& problems) { PairChecker(scene, problems).run(); }

}  // namespace annulus::app
