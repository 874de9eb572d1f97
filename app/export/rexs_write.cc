#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <pugixml.hpp>
#include <sstream>
#include <utility>

#include "app/export/rexs.h"
#include "app/plan/gear_geometry.h"
#include "app/results/content_id.h"
#include "app/scene/scene_kind.h"
#include "app/scene/scene_schema.h"
#include "app/systems/helical_pair/pair_model.h"
#include "app/systems/planetary/power_flow.h"
#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// The document as it grows; components and relations are numbered from 1.
class Rexs {
 public:
  Rexs() {
    auto declaration = document_.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    auto model = document_.append_child("model");
    model.append_attribute("version") = "1.4";
    model.append_attribute("applicationId") = "annulus";
    model.append_attribute("applicationVersion") = version();
    model.append_attribute("date") = fmt::format("{:%FT%T}Z", fmt::gmtime(std::time(nullptr))).c_str();
    relations_ = model.append_child("relations");
    components_ = model.append_child("components");
  }

  struct Component {
    int id;
    std::string type;
    pugi::xml_node node;

    void attribute(const std::string& name, const std::string& unit, const std::string& value) {
      auto child = node.append_child("attribute");
      child.append_attribute("id") = name.c_str();
      if (!unit.empty()) child.append_attribute("unit") = unit.c_str();
      child.text().set(value.c_str());
    }
    void attribute(const std::string& name, const std::string& unit, double value) {
      attribute(name, unit, fmt::format("{}", value));
    }
  };

  Component component(const std::string& type, const std::string& name) {
    auto node = components_.append_child("component");
    node.append_attribute("id") = ++last_component_;
    node.append_attribute("type") = type.c_str();
    node.append_attribute("name") = name.c_str();
    return {last_component_, type, node};
  }

  void relation(const char* type, const std::vector<std::pair<const char*, const Component*>>& roles) {
    auto node = relations_.append_child("relation");
    node.append_attribute("id") = ++last_relation_;
    node.append_attribute("type") = type;
    for (const auto& [role, component] : roles) {
      auto ref = node.append_child("ref");
      ref.append_attribute("id") = component->id;
      ref.append_attribute("role") = role;
      ref.append_attribute("hint") = component->type.c_str();
    }
  }

  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    document_.save(out, "  ");
    return out.str();
  }

 private:
  pugi::xml_document document_;
  pugi::xml_node relations_, components_;
  int last_component_ = 0, last_relation_ = 0;
};

/// Keys that REXS has attributes for; those of other tables, and these of others, become custom ones.
bool known_to_rexs(const std::string& key) {
  static const char* const known[] = {"title",
                                      "accuracy",
                                      "model",
                                      "reference",
                                      "stage.kind",
                                      "stage.planets",
                                      "stage.module_mm",
                                      "stage.pressure_angle_deg",
                                      "stage.helix_angle_deg",
                                      "stage.face_width_mm",
                                      "stage.centre_distance_mm",
                                      "material.youngs_modulus_GPa",
                                      "material.poisson_ratio",
                                      "material.density_kg_per_m3",
                                      "carrier.mass_kg"};
  if (std::find(std::begin(known), std::end(known), key) != std::end(known)) return true;
  for (const char* name : {".face_width_mm", ".name", ".teeth", ".profile_shift", ".mass_kg", ".tip_diameter_mm",
                           ".root_diameter_mm", ".youngs_modulus_GPa", ".poisson_ratio", ".density_kg_per_m3"})
    if (key.ends_with(name)) return true;
  return false;
}

/// Values of the scene that REXS has no name for, of these tables (and ring): by their keys in a table, of several
/// tables by whole keys.
void custom_attributes(Rexs::Component& component, const Scene& scene, const std::vector<std::string>& tables,
                       const std::string& ring = "") {
  for (const auto& input : scene.inputs) {
    const auto* p = find_parameter(input.key);
    if (p == nullptr || input.origin != Origin::scene || known_to_rexs(input.key)) continue;
    if (std::find(tables.begin(), tables.end(), p->table) == tables.end()) continue;
    if (!ring.empty() && input.ring != ring) continue;
    component.attribute("custom_annulus_" + (tables.size() > 1 ? p->key() : p->name), input.unit,
                        toml_text(input.value));
  }
}

/// The materials of all gears, each once.
class Materials {
 public:
  explicit Materials(Rexs& rexs) : rexs_(rexs) {}

  const Rexs::Component& component(const fem::Material& of) {
    const auto same = [&](const auto& known) {
      const fem::Material& m = known.first;
      return m.youngs_modulus == of.youngs_modulus && m.poisson_ratio == of.poisson_ratio && m.density == of.density;
    };
    if (const auto found = std::find_if(known_.begin(), known_.end(), same); found != known_.end())
      return found->second;
    auto material = rexs_.component("material", "material");
    material.attribute("elastic_modulus", "N / mm^2", of.youngs_modulus / 1e6);
    material.attribute("poisson_ratio", "none", of.poisson_ratio);
    material.attribute("density", "kg / dm^3", of.density / 1e3);
    return known_.emplace_back(of, material).second;
  }

 private:
  Rexs& rexs_;
  std::deque<std::pair<fem::Material, Rexs::Component>> known_;
};

/// A gear with its material, and both its flanks, which have pressure angle and profile shift.
Rexs::Component gear(Rexs& rexs, const Scene& scene, const std::string& name, const GearInput& input,
                     const geometry::Gear& gear, Materials& materials) {
  const auto& material = materials.component(material_of(scene, input));
  const bool internal = gear.kind() == geometry::GearKind::internal;
  auto component = rexs.component(internal ? "ring_gear" : "cylindrical_gear", name);
  // REXS follows DIN ISO 21771: the number of teeth of an internal gear is negative, and so a profile shift that
  // thickens its teeth is positive: the other way round than in a scene.
  const double sign = internal ? -1 : 1;
  component.attribute("number_of_teeth", "none", sign * gear.teeth());
  component.attribute("normal_module", "mm", scene.stage.module / units::mm);
  component.attribute("helix_angle_reference_diameter", "deg", gear.helix_angle() / units::deg);
  component.attribute("face_width", "mm", gear.parameters().face_width / units::mm);
  component.attribute("reference_circle_diameter", "mm", sign * 2 * gear.reference_radius() / units::mm);
  component.attribute("base_circle_diameter", "mm", sign * 2 * gear.base_radius() / units::mm);
  component.attribute("tip_diameter", "mm", sign * 2 * gear.tip_radius() / units::mm);
  component.attribute("root_diameter", "mm", sign * 2 * gear.root_radius() / units::mm);
  if (input.mass) component.attribute("mass_of_component", "kg", *input.mass);
  rexs.relation("reference", {{"origin", &component}, {"referenced", &material}});
  const auto flank = [&](const char* side) {
    auto part = rexs.component("cylindrical_gear_flank", name + ", " + side + " flank");
    part.attribute("normal_pressure_angle", "deg", scene.stage.pressure_angle / units::deg);
    part.attribute("addendum_modification_coefficient", "none", sign * input.profile_shift);
    return part;
  };
  const auto left = flank("left"), right = flank("right");
  rexs.relation("flank", {{"gear", &component}, {"left", &left}, {"right", &right}});
  return component;
}

/// A cylindrical stage, part of a planetary stage or of the gear unit.
void stage(Rexs& rexs, const std::string& name, double centre_distance, const Rexs::Component& whole,
           const Rexs::Component& first, const Rexs::Component& second) {
  auto component = rexs.component("cylindrical_stage", name);
  component.attribute("center_distance", "mm", centre_distance / units::mm);
  rexs.relation("assembly", {{"assembly", &whole}, {"part", &component}});
  rexs.relation("stage", {{"stage", &component}, {"gear_1", &first}, {"gear_2", &second}});
}

/// Those that belong to the stage as a whole.
const std::vector<std::string> stage_tables = {"stage",           "errors",           "supports",         "dynamics",
                                               "mesh.sun_planet", "mesh.ring_planet", "mesh.pinion_wheel"};

}  // namespace

std::string rexs_text(const Scene& computed, const std::string& ring) {
  const bool planetary_stage = computed.stage.kind == "planetary";
  const Scene scene = planetary_stage ? as_drawn(computed, make_geometry(computed).operating_point) : computed;
  if (scene.stage.kind == "two_k_v")
    throw InputError(scene.file.string() +
                     ": REXS has no arc-tooth gears; only planetary stages and pairs can be exported");
  Rexs rexs;
  auto unit = rexs.component("gear_unit", scene.title);
  Materials materials(rexs);
  if (scene.stage.kind == "helical_pair") {
    custom_attributes(unit, scene, stage_tables);
    auto pinion = gear(rexs, scene, "pinion", scene.pinion,
                       make_gear(scene, scene.pinion, geometry::GearKind::external, 1), materials);
    auto wheel = gear(rexs, scene, "wheel", scene.wheel,
                      make_gear(scene, scene.wheel, geometry::GearKind::external, -1), materials);
    custom_attributes(pinion, scene, {"pinion"});
    custom_attributes(wheel, scene, {"wheel"});
    stage(rexs, "pinion - wheel", pair_centre_distance(scene), unit, pinion, wheel);
    return rexs.text();
  }
  if (!scene_kind(scene.stage.kind).gears)
    throw InputError(fmt::format("{}: a {} has no gears of its own; export the scenes of its parts",
                                 scene.file.string(), scene.stage.kind));
  const auto found =
      std::find_if(scene.rings.begin(), scene.rings.end(), [&](const auto& r) { return r.name == ring; });
  if (found == scene.rings.end()) {
    std::string names;
    for (const auto& r : scene.rings) names += (names.empty() ? "" : ", ") + r.name;
    throw InputError(
        fmt::format("{}: has no ring '{}'; its rings are {} (--ring NAME)", scene.file.string(), ring, names));
  }
  const auto set = make_geometry(scene).rings[static_cast<std::size_t>(found - scene.rings.begin())].set;
  auto planetary = rexs.component("planetary_stage", scene.title);
  custom_attributes(planetary, scene, stage_tables);
  rexs.relation("assembly", {{"assembly", &unit}, {"part", &planetary}});
  auto carrier = rexs.component("planet_carrier", "carrier");
  if (scene.carrier.mass) carrier.attribute("mass_of_component", "kg", *scene.carrier.mass);
  custom_attributes(carrier, scene, {"carrier"});
  rexs.relation("assembly", {{"assembly", &planetary}, {"part", &carrier}});
  auto sun = gear(rexs, scene, "sun", scene.sun, set.sun_mesh().wheel(), materials);
  custom_attributes(sun, scene, {"sun"});
  auto annulus = gear(rexs, scene, "ring " + found->name, *found, set.ring_mesh().wheel(), materials);
  custom_attributes(annulus, scene, {"ring"}, found->name);
  for (int n = 1; n <= scene.stage.planets; ++n) {
    auto planet = gear(rexs, scene, fmt::format("planet {}", n), scene.planet, set.sun_mesh().pinion(), materials);
    custom_attributes(planet, scene, {"planet"});
    const double distance = scene.stage.centre_distance;
    stage(rexs, fmt::format("sun - planet {}", n), distance, planetary, sun, planet);
    // As the number of teeth of the ring.
    stage(rexs, fmt::format("planet {} - ring", n), -distance, planetary, planet, annulus);
  }
  return rexs.text();
}

}  // namespace annulus::app
