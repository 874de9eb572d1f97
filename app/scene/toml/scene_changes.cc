#include <sstream>

#include "app/scene/overrides.h"
#include "app/scene/scene_limits.h"
#include "app/scene/scene_schema.h"
#include "app/scene/toml/tables.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

toml::table& table_at(toml::table& root, const InputEdit& edit) {
  if (edit.ring) return *root.get("ring")->as_array()->get(*edit.ring)->as_table();
  toml::table* table = &root;
  std::istringstream path(edit.parameter->table);
  for (std::string name; std::getline(path, name, '.');) {
    if (!table->contains(name)) table->insert(name, toml::table{});
    table = table->get(name)->as_table();
    require(table != nullptr, "a checked scene has tables where its schema has");
  }
  return *table;
}

void set_number(toml::table& root, const InputEdit& edit) {
  const Parameter& p = *edit.parameter;
  toml::table& table = table_at(root, edit);
  if (p.kind == Parameter::Kind::integer) {
    table.insert_or_assign(p.name, static_cast<std::int64_t>(edit.value));
  } else if (p.kind == Parameter::Kind::reals) {
    toml::array list;
    const auto* present = table[p.name].as_array();
    for (std::size_t i = 0; i < edit.length; ++i)
      list.push_back(i == *edit.index                 ? edit.value
                     : present && i < present->size() ? present->get(i)->value_or(0.0)
                                                      : 0.0);
    table.insert_or_assign(p.name, std::move(list));
  } else {
    table.insert_or_assign(p.name, edit.value);
  }
}

toml::table changed_root(const Scene& scene, const std::vector<Override>& overrides) {
  require(!scene.text.empty(), "only a scene read from a file or text can be changed");
  toml::table root = toml::parse(scene.text, scene.file.string());
  // A changed scene answers one question: it has no studies of its own, and no one asks for its assumptions.
  for (const auto& table : schema()) {
    if (is_study_table(table.path)) root.erase(table.path);
  }
  root.erase("assumed");
  for (const auto& edit : resolve(scene, overrides)) set_number(root, edit);
  return root;
}

}  // namespace

Scene with_overrides(const Scene& scene, const std::vector<Override>& overrides) {
  return read_tables(changed_root(scene, overrides), scene.file);
}

Scene with_accuracy(const Scene& scene, double accuracy, const std::string& note) {
  require(!scene.text.empty(), "only a scene read from a file or text can be changed");
  toml::table root = toml::parse(scene.text, scene.file.string());
  root.insert_or_assign("accuracy", accuracy);
  std::ostringstream text;
  text << root << '\n';
  Scene changed = parse_scene(text.str(), scene.file);
  for (auto& input : changed.inputs) {
    if (input.key != "accuracy") continue;
    input.origin = Origin::derived;
    input.note = note;
  }
  return changed;
}

std::string scene_text(const Scene& scene, const std::vector<Override>& overrides) {
  toml::table root = changed_root(scene, overrides);
  root.erase("reference");  // its path is relative to the original
  std::ostringstream text;
  text << root << '\n';
  return text.str();
}

Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return with_overrides(read_scene(file), overrides);
}

}  // namespace annulus::app
