#include "app/rexs/rexs_writer.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <sstream>

#include "app/plan/gear_geometry.h"
#include "app/results/content_id.h"
#include "app/scene/new_scene.h"
#include "app/scene/scene_schema.h"
#include "core/units.h"

namespace annulus::app {

namespace {

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
                                      "material.density_kg_per_m3"};
  if (std::find(std::begin(known), std::end(known), key) != std::end(known)) return true;
  for (const char* name : {".face_width_mm", ".name", ".teeth", ".profile_shift", ".mass_kg", ".tip_diameter_mm",
                           ".root_diameter_mm", ".youngs_modulus_GPa", ".poisson_ratio", ".density_kg_per_m3"})
    if (key.ends_with(name)) return true;
  return false;
}

}  // namespace

RexsWriter::RexsWriter(const Scene& scene) : scene_(scene) {
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

void RexsWriter::Component::attribute(const std::string& name, const std::string& unit, const std::string& value) {
  auto child = node.append_child("attribute");
  child.append_attribute("id") = name.c_str();
  if (!unit.empty()) child.append_attribute("unit") = unit.c_str();
  child.text().set(value.c_str());
}

void RexsWriter::Component::attribute(const std::string& name, const std::string& unit, double value) {
  attribute(name, unit, fmt::format("{}", value));
}

RexsWriter::Component RexsWriter::component(const std::string& type, const std::string& name) {
  auto node = components_.append_child("component");
  node.append_attribute("id") = ++last_component_;
  node.append_attribute("type") = type.c_str();
  node.append_attribute("name") = name.c_str();
  return {last_component_, type, node};
}

void RexsWriter::relation(const char* type, const std::vector<std::pair<const char*, const Component*>>& roles) {
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

void RexsWriter::custom_attributes(Component& component, const std::vector<std::string>& tables,
                                   const std::string& ring) {
  for (const auto& input : scene_.inputs) {
    const auto* p = find_parameter(input.key);
    if (p == nullptr || input.origin != Origin::scene || known_to_rexs(input.key)) continue;
    if (std::find(tables.begin(), tables.end(), p->table) == tables.end()) continue;
    if (!ring.empty() && input.variant != ring) continue;
    component.attribute("custom_annulus_" + (tables.size() > 1 ? p->key() : p->name), input.unit,
                        toml_text(input.value));
  }
}

const RexsWriter::Component& RexsWriter::material(const fem::Material& of) {
  const auto same = [&](const auto& known) {
    const fem::Material& m = known.first;
    return m.youngs_modulus == of.youngs_modulus && m.poisson_ratio == of.poisson_ratio && m.density == of.density;
  };
  if (const auto found = std::find_if(materials_.begin(), materials_.end(), same); found != materials_.end())
    return found->second;
  auto material = component("material", "material");
  material.attribute("elastic_modulus", "N / mm^2", of.youngs_modulus / 1e6);
  material.attribute("poisson_ratio", "none", of.poisson_ratio);
  material.attribute("density", "kg / dm^3", of.density / 1e3);
  return materials_.emplace_back(of, material).second;
}

RexsWriter::Component RexsWriter::gear(const std::string& name, const GearInput& input, const geometry::Gear& gear) {
  const auto& made_of = material(material_of(scene_, input));
  const bool internal = gear.kind() == geometry::GearKind::internal;
  auto result = component(internal ? "ring_gear" : "cylindrical_gear", name);
  // REXS follows DIN ISO 21771: the number of teeth of an internal gear is negative, and so a profile shift that
  // thickens its teeth is positive: the other way round than in a scene.
  const double sign = internal ? -1 : 1;
  result.attribute("number_of_teeth", "none", sign * gear.teeth());
  result.attribute("normal_module", "mm", scene_.stage.module / units::mm);
  result.attribute("helix_angle_reference_diameter", "deg", gear.helix_angle() / units::deg);
  result.attribute("face_width", "mm", gear.parameters().face_width / units::mm);
  result.attribute("reference_circle_diameter", "mm", sign * 2 * gear.reference_radius() / units::mm);
  result.attribute("base_circle_diameter", "mm", sign * 2 * gear.base_radius() / units::mm);
  result.attribute("tip_diameter", "mm", sign * 2 * gear.tip_radius() / units::mm);
  result.attribute("root_diameter", "mm", sign * 2 * gear.root_radius() / units::mm);
  if (input.mass) result.attribute("mass_of_component", "kg", *input.mass);
  relation("reference", {{"origin", &result}, {"referenced", &made_of}});
  const auto flank = [&](const char* side) {
    auto part = component("cylindrical_gear_flank", name + ", " + side + " flank");
    part.attribute("normal_pressure_angle", "deg", scene_.stage.pressure_angle / units::deg);
    part.attribute("addendum_modification_coefficient", "none", sign * input.profile_shift);
    return part;
  };
  const auto left = flank("left"), right = flank("right");
  relation("flank", {{"gear", &result}, {"left", &left}, {"right", &right}});
  return result;
}

void RexsWriter::stage(const std::string& name, double centre_distance, const Component& whole, const Component& first,
                       const Component& second) {
  auto result = component("cylindrical_stage", name);
  result.attribute("center_distance", "mm", centre_distance / units::mm);
  relation("assembly", {{"assembly", &whole}, {"part", &result}});
  relation("stage", {{"stage", &result}, {"gear_1", &first}, {"gear_2", &second}});
}

std::string RexsWriter::text() const {
  std::ostringstream out;
  document_.save(out, "  ");
  return out.str();
}

}  // namespace annulus::app
