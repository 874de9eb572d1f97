#include "app/rexs/rexs_reader.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <boost/locale/utf.hpp>
#include <charconv>
#include <cmath>

#include "app/scene/scene_limits.h"
#include "app/scene/scene_schema.h"
#include "core/files.h"

namespace annulus::app {

namespace {

constexpr const char* custom_prefix = "custom_annulus_";

/// Where a text stops being UTF-8.
std::optional<std::size_t> not_utf8(const std::string& text) {
  namespace utf = boost::locale::utf;
  for (auto at = text.begin(); at != text.end();) {
    const auto character = at;
    if (!utf::is_valid_codepoint(utf::utf_traits<char>::decode(at, text.end()))) return character - text.begin();
  }
  return std::nullopt;
}

/// Whether the text of a custom attribute can stand in a scene: one value on one line.
bool is_one_value(const std::string& text) {
  if (std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; })) return false;
  try {
    return toml::parse("value = " + text).size() == 1;
  } catch (const toml::parse_error&) {
    return false;
  }
}

/// The component in that role of a relation; 0 when there is none.
int role(const pugi::xml_node& relation, const char* name) {
  const auto ref = relation.find_child_by_attribute("ref", "role", name);
  return ref ? ref.attribute("id").as_int() : 0;
}

}  // namespace

RexsFile::RexsFile(const std::filesystem::path& file) : file_(file.string()) {
  const std::string text = read_file(file);
  const auto result = document_.load_buffer(text.data(), text.size());
  if (!result) throw refusal(fmt::format("cannot be read as XML: {} (byte {})", result.description(), result.offset));
  if (const auto at = result.encoding == pugi::encoding_utf8 ? not_utf8(text) : std::nullopt)
    throw refusal(fmt::format("is not UTF-8 (byte {}) and declares no other encoding", *at));
  const auto model = document_.child("model");
  if (!model) throw refusal("has no element 'model'; is it a REXS file?");
  if (const std::string version = model.attribute("version").value(); !version.starts_with("1."))
    throw refusal(fmt::format("is REXS version '{}'; 1.x can be read", shown(version)));
  for (const auto node : model.child("components").children("component")) {
    const int id = node.attribute("id").as_int();
    components_[id] = {id, node.attribute("type").value(), node.attribute("name").value(), node};
  }
  for (const auto node : model.child("relations").children("relation")) relations_.push_back(node);
}

const RexsFile::Component& RexsFile::component(int id) const {
  const auto found = components_.find(id);
  if (found == components_.end()) throw refusal(fmt::format("a relation names component {}, which is not there", id));
  return found->second;
}

std::vector<RexsFile::Stage> RexsFile::stages() const {
  std::vector<Stage> list;
  for (const auto& relation : relations_) {
    if (std::string(relation.attribute("type").value()) != "stage") continue;
    list.push_back({role(relation, "stage"), role(relation, "gear_1"), role(relation, "gear_2")});
  }
  return list;
}

std::vector<RexsFile::Component> RexsFile::related(const char* type, const char* from, int id,
                                                   std::initializer_list<const char*> to) const {
  std::vector<Component> list;
  for (const auto& relation : relations_) {
    if (std::string(relation.attribute("type").value()) != type || role(relation, from) != id) continue;
    for (const char* name : to)
      if (const int other = role(relation, name)) list.push_back(component(other));
  }
  return list;
}

std::vector<RexsFile::Component> RexsFile::of_type(const std::string& type) const {
  std::vector<Component> list;
  for (const auto& [id, c] : components_)
    if (c.type == type) list.push_back(c);
  return list;
}

std::optional<double> RexsFile::number(const Component& c, const char* name, const std::string& unit) const {
  const auto node = c.node.find_child_by_attribute("attribute", "id", name);
  if (!node) return std::nullopt;
  const std::string text = node.text().get();
  double value = 0;
  const auto* first = text.data() + std::min(text.find_first_not_of(" \t\r\n"), text.size());
  const auto* last = text.data() + (text.find_last_not_of(" \t\r\n") + 1);  // of blanks alone: the begin
  const auto [end, error] = std::from_chars(first, std::max(first, last), value);
  if (error != std::errc{} || end != last || !std::isfinite(value))
    throw refusal(fmt::format("component {}: {} = '{}' is not a number", c.id, name, shown(text)));
  std::string given = node.attribute("unit").value();
  if (given == "°") given = "deg";  // as up to version 1.3
  if (given.empty() || given == unit) return value;
  static const std::map<std::pair<std::string, std::string>, double> factors = {
      {{"m", "mm"}, 1e3},       {{"mum", "mm"}, 1e-3},      {{"rad", "deg"}, 180 / 3.14159265358979323846},
      {{"MPa", "N / mm^2"}, 1}, {{"GPa", "N / mm^2"}, 1e3}, {{"kg / m^3", "kg / dm^3"}, 1e-3},
      {{"g", "kg"}, 1e-3}};
  const auto factor = factors.find({given, unit});
  if (factor == factors.end())
    throw refusal(fmt::format("component {}: {} is in '{}'; '{}' is expected", c.id, name, shown(given), unit));
  return value * factor->second;
}

void RexsValues::put(const std::string& key, std::optional<double> value, const std::string& remark) {
  if (value) values[key] = {toml_text(Value(*value)), remark};
}
void RexsValues::put_count(const std::string& key, double value) {
  if (value > 1e6) throw file_.refusal(fmt::format("{} = {} is not possible in a scene", key, value));
  values[key] = {std::to_string(std::lround(value)), ""};
}
void RexsValues::put_text(const std::string& key, const std::string& text) {
  values[key] = {toml_text(Value(text)), ""};
}

void RexsValues::custom(const Component& c, const std::string& table) {
  for (const auto node : c.node.children("attribute")) {
    const std::string id = node.attribute("id").value();
    if (!id.starts_with(custom_prefix)) continue;
    const std::string key = (table.empty() ? "" : table + ".") + id.substr(std::string(custom_prefix).size());
    const std::string text = node.text().get();
    if (find_parameter(key) == nullptr) continue;
    if (!is_one_value(text))
      throw file_.refusal(
          fmt::format("component {}: {} = '{}' is not possible in a scene", c.id, shown(id), shown(text)));
    values[key] = {text, ""};
  }
}

void RexsValues::gear(const Component& c, const std::string& table) {
  const bool internal = c.type == "ring_gear";
  const auto teeth = file_.number(c, "number_of_teeth", "none");
  if (!teeth) throw file_.refusal(fmt::format("component {} ({}): has no number_of_teeth", c.id, c.type));
  put_count(table + ".teeth", std::abs(*teeth));
  const auto flanks = file_.related("flank", "gear", c.id, {"left", "right"});
  std::optional<double> shift;
  for (const auto& part : flanks)
    for (const char* name : {"profile_shift_coefficient", "addendum_modification_coefficient"})
      if (!shift) shift = file_.number(part, name, "none");
  const bool turned = internal && *teeth < 0;
  if (shift)
    put(table + ".profile_shift", turned && *shift != 0 ? -*shift : *shift,
        internal && !turned ? "sign as in the REXS file, where the number of teeth is positive: check it" : "");
  for (const auto& [key, name] : {std::pair{"tip_diameter_mm", "tip_diameter"}, {"root_diameter_mm", "root_diameter"}})
    if (const auto value = file_.number(c, name, "mm")) put(table + "." + key, std::abs(*value));
  put(table + ".mass_kg", file_.number(c, "mass_of_component", "kg"));
  if (const auto width = file_.number(c, "face_width", "mm")) {
    const auto common = values.find("stage.face_width_mm");
    if (common == values.end() || common->second.text != toml_text(Value(*width)))
      put(table + ".face_width_mm", *width);
  }
  material(c, table);
  custom(c, table);
}

void RexsValues::common(const Component& c, const std::optional<double>& centre_distance) {
  put("stage.module_mm", file_.number(c, "normal_module", "mm"));
  put("stage.face_width_mm", file_.number(c, "face_width", "mm"));
  if (const auto helix = file_.number(c, "helix_angle_reference_diameter", "deg"); helix && *helix != 0)
    put("stage.helix_angle_deg", std::abs(*helix));
  for (const auto& part : file_.related("flank", "gear", c.id, {"left", "right"}))
    put("stage.pressure_angle_deg", file_.number(part, "normal_pressure_angle", "deg"));
  if (centre_distance) put("stage.centre_distance_mm", std::abs(*centre_distance));
  material(c, "material");
}

void RexsValues::operating_point(const Component& gear, const std::string& speed_key, const std::string& torque_key) {
  std::vector<Component> places = {gear};
  for (const auto& shaft : file_.related("assembly", "part", gear.id, {"assembly"}))
    if (shaft.type == "shaft") places.push_back(shaft);
  std::vector<double> torques;
  for (const auto& place : places) {
    if (const auto speed = file_.number(place, "rotational_speed", "1 / min"); speed && *speed != 0)
      put(speed_key, std::abs(*speed));
    for (const auto& load : file_.related("assembly", "assembly", place.id, {"part"}))
      if (const auto torque = file_.number(load, "torque_around_u_axis", "N m"); torque && *torque != 0)
        torques.push_back(std::abs(*torque));
  }
  // Of several loads that of the gear is not known.
  if (torques.size() == 1) put(torque_key, torques.front());
}

void RexsValues::material(const Component& c, const std::string& table) {
  const auto own = [&](const char* key, std::optional<double> value, double factor) {
    if (!value) return;
    const auto common = values.find(std::string("material.") + key);
    const auto text = toml_text(Value(*value * factor));
    if (common == values.end() || common->second.text != text) values[table + "." + key] = {text, ""};
  };
  for (const auto& m : file_.related("reference", "origin", c.id, {"referenced"})) {
    if (m.type != "material") continue;
    own("youngs_modulus_GPa", file_.number(m, "elastic_modulus", "N / mm^2"), 1e-3);
    own("poisson_ratio", file_.number(m, "poisson_ratio", "none"), 1);
    own("density_kg_per_m3", file_.number(m, "density", "kg / dm^3"), 1e3);
  }
}

}  // namespace annulus::app
