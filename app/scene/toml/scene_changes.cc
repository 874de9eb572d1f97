#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "app/scene/key_path.h"
#include "app/scene/overrides.h"
#include "app/scene/scene_schema.h"
#include "app/scene/toml/values.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

toml::table& table_at(toml::table& root, const InputTarget& target, std::size_t entry) {
  if (!target.tables.empty()) return *root.get(target.parameter->table)->as_array()->get(entry)->as_table();
  toml::table* table = &root;
  std::istringstream path(target.parameter->table);
  for (std::string name; std::getline(path, name, '.');) {
    table->insert(name, toml::table{});  // unless there is one
    table = table->get(name)->as_table();
    require(table != nullptr, "a checked scene has tables where its schema has");
  }
  return *table;
}

/// The number that an override gives its input in one table.
double changed_value(const Scene& scene, const InputTarget& target, std::size_t entry, const Override& change) {
  double value = change.value;
  if (change.factor) {
    const auto present = input_value(scene, target, entry);
    if (!present) throw InputError(change.input + ": has no value in this scene that could be multiplied");
    if (std::isinf(*present)) throw InputError(change.input + ": is rigid (inf), a factor does not change it");
    value *= *present;
  }
  const bool whole = target.parameter->kind == Parameter::Kind::integer;
  if (whole && (value != std::floor(value) || std::abs(value) > 1e9))
    throw InputError(
        fmt::format("{} = {}: must be a whole number; it is not rounded", change.input, to_text(value, 15)));
  return value;
}

void apply(const Scene& scene, const Override& change, toml::table& root) {
  const auto target = find_input(scene, change.input);
  const Parameter& p = *target.parameter;
  for (const auto entry : target.entries()) {
    const double value = changed_value(scene, target, entry, change);
    toml::table& table = table_at(root, target, entry);
    if (p.kind == Parameter::Kind::integer) {
      table.insert_or_assign(p.name, static_cast<std::int64_t>(value));
    } else if (target.index) {
      if (!table[p.name].is_array()) table.insert_or_assign(p.name, toml::array{});
      auto& list = *table[p.name].as_array();
      for (const double x : target.list)
        if (list.size() < target.list.size()) list.push_back(x);
      list.replace(list.cbegin() + static_cast<std::ptrdiff_t>(*target.index), value);
    } else {
      table.insert_or_assign(p.name, value);
    }
  }
}

toml::table root_of(const Scene& scene) {
  require(!scene.text.empty(), "only a scene read from a file or text can be changed");
  return parse_toml(scene.text, scene.file.string());
}

std::string text_of(const toml::table& root) {
  std::ostringstream text;
  text << root << '\n';
  return text.str();
}

toml::table changed_root(const Scene& scene, const std::vector<Override>& overrides) {
  toml::table root = root_of(scene);
  // A changed scene answers one question: it has no studies of its own, and no one asks for its assumptions.
  for (const auto& table : schema())
    if (table.role == Table::Role::study) root.erase(table.path);
  root.erase("assumed");
  for (const auto& change : overrides) apply(scene, change, root);
  return root;
}

}  // namespace

Scene with_overrides(const Scene& scene, const std::vector<Override>& overrides) {
  return read_tables(changed_root(scene, overrides), scene.file);
}

Scene with_accuracy(const Scene& scene, double accuracy, const std::string& note) {
  toml::table root = root_of(scene);
  root.insert_or_assign("accuracy", accuracy);
  Scene changed = parse_scene(text_of(root), scene.file);
  for (auto& input : changed.inputs) {
    if (input.key != "accuracy") continue;
    input.origin = Origin::derived;
    input.note = note;
  }
  return changed;
}

namespace {

toml::table value_of_setting(const std::string& text) {
  try {
    return toml::parse("x = " + text);
  } catch (const toml::parse_error&) {
    return toml::table{{"x", text}};
  }
}

[[noreturn]] void refuse_setting(const std::string& setting, const std::string& why) {
  throw InputError("--set " + setting + ": " + why);
}

/// Puts the value of a TOML key `x` under a name, or into its list where the name has an index: "mass_kg", "angles[2]".
void put(toml::table& table, const KeyPath& key, const toml::table& value, const std::string& setting) {
  const auto& node = *value.get("x");
  if (!key.index) {
    node.visit([&](const auto& found) { table.insert_or_assign(key.key, found); });
    return;
  }
  auto* list = table[key.key].as_array();
  if (list == nullptr)
    refuse_setting(setting, table.contains(key.key) ? "is one value, not a list"
                                                    : "the scene has no such list; set it as a whole first");
  const auto place = parse_index("--set " + setting, *key.index, list->size());
  node.visit([&](const auto& found) { list->replace(list->cbegin() + static_cast<std::ptrdiff_t>(place), found); });
}

/// The array of tables with names that a path begins with; null where it is another table.
const Table* named_array(const std::string& head) {
  for (const auto& table : schema())
    if (table.repeated && find_parameter(table.path + ".name") &&
        (head == table.path || head.starts_with(table.path + ".")))
      return &table;
  return nullptr;
}

void apply_setting(toml::table& root, const std::string& setting) {
  const auto equal = setting.find('=');
  if (equal == std::string::npos) refuse_setting(setting, "must be KEY=VALUE");
  const auto trimmed = [](const std::string& text) {
    const auto begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
    return begin == std::string::npos ? std::string() : text.substr(begin, end - begin + 1);
  };
  const auto path = trimmed(setting.substr(0, equal)), text = trimmed(setting.substr(equal + 1));
  const auto value = value_of_setting(text);
  if (value.size() != 1) refuse_setting(setting, "has several keys; give each one with a --set of its own");
  const auto dot = path.rfind('.');
  const auto name = split_path(dot == std::string::npos ? path : path.substr(dot + 1));
  auto head = dot == std::string::npos ? std::string() : path.substr(0, dot);
  // [[ring]], [[bearing]]: of all tables, or of the one that is named.
  const auto* array = named_array(head);
  const auto table_name =
      array != nullptr && head.size() > array->path.size() ? head.substr(array->path.size() + 1) : std::string();
  if (array != nullptr) head = array->path;
  const auto key = head.empty() ? name.key : head + "." + name.key;
  if (!find_parameter(key)) refuse_setting(setting, "there is no such key" + did_you_mean(key, all_keys()));
  const auto* declared = find_table(head);
  if (array != nullptr) {
    auto* tables = root[head].as_array();
    bool found = false;
    for (std::size_t i = 0; tables != nullptr && i < tables->size(); ++i) {
      auto* table = tables->get(i)->as_table();
      if (table == nullptr || (!table_name.empty() && (*table)["name"].value_or(std::string()) != table_name)) continue;
      put(*table, name, value, setting);
      found = true;
    }
    if (!found) refuse_setting(setting, fmt::format("the scene has no such [[{}]]", head));
    return;
  }
  if (declared->repeated) refuse_setting(setting, declared->header() + " are several; edit the scene");
  toml::table* table = &root;
  std::istringstream parts(head);
  for (std::string part; std::getline(parts, part, '.');) {
    table->insert(part, toml::table{});  // unless there is one
    table = table->get(part)->as_table();
    if (table == nullptr) refuse_setting(setting, part + " is no table in the scene");
  }
  put(*table, name, value, setting);
}

}  // namespace

Scene read_scene_with(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  if (settings.empty()) return read_scene(file);
  auto root = parse_toml(text_of_file(file), file.string());
  for (const auto& setting : settings) apply_setting(root, setting);
  Scene scene = read_tables(root, file);
  scene.text = text_of(root);
  return scene;
}

std::string scene_text(const Scene& scene, const std::vector<Override>& overrides) {
  toml::table root = changed_root(scene, overrides);
  root.erase("reference");  // its path is relative to the original
  return text_of(root);
}

}  // namespace annulus::app
