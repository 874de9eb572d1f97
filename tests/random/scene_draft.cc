#include "tests/random/scene_draft.h"

#include <algorithm>
#include <stdexcept>

#include "app/scene/new_scene.h"

namespace annulus::random {

namespace {

std::pair<std::string, std::string> split(const std::string& key) {
  const auto dot = key.rfind('.');
  if (dot == std::string::npos) return {"", key};
  return {key.substr(0, dot), key.substr(dot + 1)};
}

template <class Tables>
auto find_path(Tables& tables, const std::string& path) {
  const auto found = std::find_if(tables.begin(), tables.end(), [&](const auto& t) { return t.path == path; });
  return found == tables.end() ? nullptr : &*found;
}

template <class Values>
auto find_name(Values& values, const std::string& name) {
  return std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == name; });
}

}  // namespace

SceneDraft::DraftTable* SceneDraft::table(const std::string& path) { return find_path(tables_, path); }
const SceneDraft::DraftTable* SceneDraft::table(const std::string& path) const { return find_path(tables_, path); }

const app::Value* SceneDraft::find(const std::string& key) const {
  const auto [path, name] = split(key);
  const auto* t = table(path);
  if (t == nullptr) return nullptr;
  const auto found = find_name(t->values, name);
  return found == t->values.end() ? nullptr : &found->second;
}

bool SceneDraft::has_table(const std::string& path) const { return table(path) != nullptr; }

void SceneDraft::open_table(const std::string& path) {
  if (!has_table(path)) tables_.push_back({path, {}});
}

void SceneDraft::set(const std::string& key, app::Value value) {
  const auto [path, name] = split(key);
  open_table(path);
  auto& values = table(path)->values;
  const auto found = find_name(values, name);
  if (found == values.end())
    values.emplace_back(name, std::move(value));
  else
    found->second = std::move(value);
}

void SceneDraft::remove(const std::string& key) {
  const auto [path, name] = split(key);
  auto* t = table(path);
  if (t == nullptr) return;
  if (const auto found = find_name(t->values, name); found != t->values.end()) t->values.erase(found);
}

void SceneDraft::remove_table(const std::string& path) {
  std::erase_if(tables_, [&](const DraftTable& t) { return t.path == path; });
}

double SceneDraft::number(const std::string& key) const {
  if (const auto* value = find(key)) {
    if (const auto* real = std::get_if<double>(value)) return *real;
    if (const auto* integer = std::get_if<long>(value)) return static_cast<double>(*integer);
  }
  throw std::logic_error(key + " is no number of the scene");
}

std::string SceneDraft::text_of(const std::string& key) const {
  const auto* value = find(key);
  const auto* text = value ? std::get_if<std::string>(value) : nullptr;
  return text ? *text : "";
}

void SceneDraft::scale(const std::string& key, double factor) {
  const auto* found = find(key);
  if (found == nullptr) return;
  app::Value value = *found;
  if (auto* list = std::get_if<std::vector<double>>(&value))
    for (double& x : *list) x *= factor;
  else
    value = number(key) * factor;
  set(key, std::move(value));
}

std::vector<app::Input> SceneDraft::inputs(const std::vector<app::Table>& tables) const {
  const auto kind = text_of("stage.kind");
  std::vector<app::Input> list;
  for (const auto& t : tables) {
    // As the reader: an optional table whose keys are all optional has its defaults without being written.
    const bool needs_presence = t.required || t.repeated || t.on_request ||
                                std::any_of(t.parameters.begin(), t.parameters.end(),
                                            [&](const app::Parameter& p) { return p.required(kind); });
    if (!t.path.empty() && needs_presence && !has_table(t.path)) continue;
    for (const auto& p : t.parameters) {
      app::Input input;
      input.key = p.key();
      if (const auto* written = find(p.key())) {
        input.value = *written;
      } else {
        if (p.required(kind)) continue;
        input.value = p.default_value;
        input.origin = app::Origin::default_value;
      }
      list.push_back(std::move(input));
    }
  }
  return list;
}

std::string SceneDraft::toml(const std::vector<app::Table>& tables) const {
  std::string text;
  for (const auto& t : tables) {
    const auto* written = table(t.path);
    if (written == nullptr) continue;
    if (!t.path.empty()) text += "\n" + t.header() + "\n";
    for (const auto& p : t.parameters) {
      const auto found = find_name(written->values, p.name);
      if (found != written->values.end()) text += p.name + " = " + app::toml_text(found->second) + "\n";
    }
  }
  return text;
}

}  // namespace annulus::random
