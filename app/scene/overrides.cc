#include "app/scene/overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scene/key_path.h"

namespace annulus::app {

namespace {

bool numeric(const Parameter& p) {
  using Kind = Parameter::Kind;
  return (p.kind == Kind::integer || p.kind == Kind::real || p.kind == Kind::reals) && !is_study_table(p.table);
}

bool applies(const Scene& scene, const Parameter& p) { return find_parameter(p.key(), schema(scene.stage.kind)); }

/// Names of the tables of an array, in their order; empty for other tables and arrays without names.
std::vector<std::string> names_in(const Scene& scene, const Table& table) {
  std::vector<std::string> names;
  if (!table.repeated || is_study_table(table.path)) return names;
  for (const auto& input : scene.inputs) {
    const auto* name = std::get_if<std::string>(&input.value);
    if (input.key != table.path + ".name" || name == nullptr) continue;
    names.resize(std::max(names.size(), input.entry + 1));
    names[input.entry] = *name;
  }
  return names;
}

/// Every path the scene knows, lists without their index.
std::vector<std::string> all_paths(const Scene& scene) {
  std::vector<std::string> paths;
  for (const auto& table : schema(scene.stage.kind)) {
    for (const auto& p : table.parameters) {
      if (!numeric(p)) continue;
      paths.push_back(p.key());
      for (const auto& name : names_in(scene, table)) paths.push_back(table.path + "." + name + "." + p.name);
    }
  }
  return paths;
}

InputError unknown(const Scene& scene, const std::string& path, const std::string& key) {
  const auto* known = find_parameter(key);
  if (known && applies(scene, *known))
    return InputError(fmt::format("{}: is {}, not a number that can be varied", path, known->type_text()));
  if (const auto now = renamed_key(key); !now.empty()) return InputError(fmt::format("{}: is now {}", path, now));
  return InputError(fmt::format("{}: there is no such numeric input{}{}", path,
                                known ? fmt::format(" of a stage of kind \"{}\"", scene.stage.kind) : "",
                                did_you_mean(key, all_paths(scene), "; see `annulus explain`")));
}

/// Tables of an array by "array.NAME.key" (a name may hold dots), or all that give "array.key"; sets the schema key.
std::vector<std::size_t> find_tables(const Scene& scene, const std::string& path, std::string& key,
                                     const Table& array) {
  const auto names = names_in(scene, array);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string prefix = array.path + "." + names[i] + ".";
    if (!key.starts_with(prefix) || !find_parameter(array.path + "." + key.substr(prefix.size()))) continue;
    key = array.path + "." + key.substr(prefix.size());
    return {i};
  }
  const Parameter* p = find_parameter(key);
  if (!p) throw unknown(scene, path, key);
  std::vector<std::size_t> found;
  const auto add = [&](const auto& is_wanted) {
    for (const auto& input : scene.inputs)
      if (input.key == key && is_wanted(input)) found.push_back(input.entry);
  };
  add([](const Input& input) { return input.origin == Origin::scene; });
  // A default holds for every table that has it.
  if (found.empty() && p->presence == Parameter::Presence::defaulted)
    add([](const Input& input) { return !std::holds_alternative<std::monostate>(input.value); });
  if (found.empty())
    throw InputError(fmt::format("{}: no {} of this scene has this key; {}.NAME.{} sets it for one {}", path,
                                 array.path, array.path, p->name, array.path));
  return found;
}

/// Lists that default to one value per planet; others have as many as teeth, pins or whatever they list.
bool has_one_per_planet(const Parameter& p) {
  return p.table == "errors" && p.presence == Parameter::Presence::defaulted;
}

}  // namespace

std::vector<std::string> variant_names(const Scene& scene) {
  for (const auto& table : schema(scene.stage.kind))
    if (table.variants) return names_in(scene, table);
  return {};
}

std::string variant_word(const std::string& kind) {
  for (const auto& table : schema(kind))
    if (table.variants) return table.path;
  return "variant";
}

InputTarget find_input(const Scene& scene, const std::string& path) {
  auto [key, index] = split_path(path);
  InputTarget target;
  const auto* table = find_table(key.substr(0, key.find('.')), schema(scene.stage.kind));
  if (table != nullptr && table->repeated && !is_study_table(table->path))
    target.tables = find_tables(scene, path, key, *table), target.by_variant = table->variants;
  target.parameter = find_parameter(key);
  if (!target.parameter || !numeric(*target.parameter) || !applies(scene, *target.parameter))
    throw unknown(scene, path, key);
  const bool is_list = target.parameter->kind == Parameter::Kind::reals;
  if (index && !is_list) throw InputError(path + ": is a single number, not a list");
  if (!is_list) return target;
  const bool planets = has_one_per_planet(*target.parameter);
  if (!index)
    throw InputError(fmt::format("{0}: is a list; name one value, as {0}[1]{1}", path, planets ? " for planet 1" : ""));
  for (const auto entry : target.entries()) {
    const Input* input = scene.find(key, entry);
    const auto* list = input ? std::get_if<std::vector<double>>(&input->value) : nullptr;
    if (list && (target.list.empty() || list->size() < target.list.size())) target.list = *list;
  }
  if (!planets && target.list.empty()) throw InputError(path + ": this scene has no such list");
  if (planets && target.list.empty()) target.list.resize(static_cast<std::size_t>(scene.stage.planets));
  target.index = parse_index(path, *index, target.list.size(), planets ? ", the number of the planet" : "");
  return target;
}

std::optional<double> input_value(const Scene& scene, const InputTarget& target, std::optional<std::size_t> entry) {
  const Input* input = scene.find(target.parameter->key(), entry.value_or(target.entries().front()));
  if (!input) return std::nullopt;
  if (const auto* v = std::get_if<long>(&input->value)) return static_cast<double>(*v);
  if (const auto* v = std::get_if<double>(&input->value)) return *v;
  if (const auto* v = std::get_if<std::vector<double>>(&input->value); v && target.index)
    return *target.index < v->size() ? (*v)[*target.index] : 0.0;
  return std::nullopt;
}

std::optional<double> value_in_variant(const Scene& scene, const InputTarget& target, std::size_t variant) {
  return target.by_variant ? input_value(scene, target, variant) : input_value(scene, target);
}

std::vector<std::string> expand_planets(const Scene& scene, const std::string& path) {
  const auto [key, index] = split_path(path);
  if (index != "*") return {path};
  std::vector<std::string> paths;
  const auto* p = find_parameter(key);
  const Input* input = p && !has_one_per_planet(*p) ? scene.find(key) : nullptr;
  const auto* list = input ? std::get_if<std::vector<double>>(&input->value) : nullptr;
  const auto count = list ? list->size() : static_cast<std::size_t>(scene.stage.planets);
  for (std::size_t n = 1; n <= count; ++n) paths.push_back(fmt::format("{}[{}]", key, n));
  return paths;
}

std::string file_name(const std::string& path) {
  std::string name;
  for (const char c : path) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '_';
    if (plain || c != ']') name += plain ? c : '_';
  }
  return name;
}

}  // namespace annulus::app
