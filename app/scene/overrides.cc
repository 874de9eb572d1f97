#include "app/scene/overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace annulus::app {

namespace {

bool numeric(const Parameter& p) {
  using Kind = Parameter::Kind;
  return (p.kind == Kind::integer || p.kind == Kind::real || p.kind == Kind::reals) && !is_study_table(p.table);
}

const Input* find_in(const Scene& scene, const std::string& key, std::size_t entry) {
  for (const auto& input : scene.inputs) {
    if (input.key == key && input.entry == entry) return &input;
  }
  return nullptr;
}

bool applies(const Scene& scene, const Parameter& p) {
  const auto& tables = schema(scene.stage.kind);
  return std::any_of(tables.begin(), tables.end(), [&](const Table& table) {
    return table.path == p.table && std::any_of(table.parameters.begin(), table.parameters.end(),
                                                [&](const Parameter& own) { return own.name == p.name; });
  });
}

/// Every path the scene knows, lists without their index.
std::vector<std::string> all_paths(const Scene& scene) {
  std::vector<std::string> paths;
  for (const auto& table : schema(scene.stage.kind)) {
    for (const auto& p : table.parameters) {
      if (!numeric(p)) continue;
      paths.push_back(p.key());
      if (p.table != "ring") continue;
      for (const auto& ring : scene.rings) paths.push_back("ring." + ring.name + "." + p.name);
    }
  }
  return paths;
}

struct Path {
  std::string key;  ///< without index
  std::string index;
  bool has_index = false;
};

Path split(const std::string& path) {
  const auto bracket = path.find('[');
  if (bracket == std::string::npos || !path.ends_with(']')) return {path, "", false};
  return {path.substr(0, bracket), path.substr(bracket + 1, path.size() - bracket - 2), true};
}

InputError unknown(const Scene& scene, const std::string& path, const std::string& key) {
  const auto* known = find_parameter(key);
  if (known && applies(scene, *known))
    return InputError(fmt::format("{}: is {}, not a number that can be varied", path, known->type_text()));
  if (const auto now = renamed_key(key); !now.empty()) return InputError(fmt::format("{}: is now {}", path, now));
  const std::string near = nearest(key, all_paths(scene));
  return InputError(fmt::format("{}: there is no such numeric input{}{}", path,
                                known ? fmt::format(" of a stage of kind \"{}\"", scene.stage.kind) : "",
                                near.empty() ? "; see `annulus explain`" : "; did you mean " + near + "?"));
}

/// Rings named by "ring.NAME.key" (a name may hold dots), or all that give "ring.key"; sets the schema key.
std::vector<std::size_t> find_rings(const Scene& scene, const std::string& path, std::string& key) {
  std::vector<std::size_t> rings;
  for (std::size_t i = 0; i < scene.rings.size(); ++i) {
    const std::string prefix = "ring." + scene.rings[i].name + ".";
    if (!key.starts_with(prefix) || !find_parameter("ring." + key.substr(prefix.size()))) continue;
    key = "ring." + key.substr(prefix.size());
    return {i};
  }
  if (!find_parameter(key)) throw unknown(scene, path, key);
  for (std::size_t i = 0; i < scene.rings.size(); ++i) {
    const Input* input = find_in(scene, key, i);
    if (input && input->origin == Origin::scene) rings.push_back(i);
  }
  const Parameter& p = *find_parameter(key);
  // A default holds for every ring that has it.
  if (rings.empty() && p.presence == Parameter::Presence::defaulted) {
    for (std::size_t i = 0; i < scene.rings.size(); ++i) {
      const Input* input = find_in(scene, key, i);
      if (input && !std::holds_alternative<std::monostate>(input->value)) rings.push_back(i);
    }
  }
  if (rings.empty())
    throw InputError(fmt::format("{}: no ring of this scene gives it; ring.NAME.{} sets it for one", path, p.name));
  return rings;
}

/// Length of a list: what the scene gives, or one value per planet.
std::size_t list_length(const Scene& scene, const Parameter& p, std::size_t entry) {
  const Input* input = find_in(scene, p.key(), entry);
  const auto* list = input ? std::get_if<std::vector<double>>(&input->value) : nullptr;
  if (list && !list->empty()) return list->size();
  return p.table == "errors" ? static_cast<std::size_t>(scene.stage.planets) : 0;
}

/// From 0. `meaning`: of the index, for messages.
std::size_t parse_index(const std::string& path, const std::string& text, std::size_t length, const char* meaning) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number < 1 || number > length)
    throw InputError(fmt::format("{}: [{}] must be a number from 1 to {}{}", path, text, length, meaning));
  return number - 1;
}

/// The value an override sets for one table of its input.
InputEdit edit_of(const Scene& scene, const InputTarget& target, std::size_t entry, const Override& change) {
  const Parameter& p = *target.parameter;
  double value = change.value;
  if (change.factor) {
    const auto present = input_value(scene, target, entry);
    if (!present) throw InputError(change.input + ": has no value in this scene that could be multiplied");
    if (std::isinf(*present)) throw InputError(change.input + ": is rigid (inf), a factor does not change it");
    value *= *present;
  }
  const bool whole = p.kind == Parameter::Kind::integer;
  if (whole && (value != std::floor(value) || std::abs(value) > 1e9))
    throw InputError(
        fmt::format("{} = {}: must be a whole number, and is never rounded", change.input, to_text(value, 15)));
  InputEdit edit{.parameter = &p, .value = value, .index = target.index};
  if (!target.rings.empty()) edit.ring = entry;
  if (target.index) edit.length = list_length(scene, p, entry);
  return edit;
}

}  // namespace

InputTarget find_input(const Scene& scene, const std::string& path) {
  auto [key, index, has_index] = split(path);
  InputTarget target;
  if (key.starts_with("ring.")) target.rings = find_rings(scene, path, key);
  target.parameter = find_parameter(key);
  if (!target.parameter || !numeric(*target.parameter) || !applies(scene, *target.parameter))
    throw unknown(scene, path, key);
  const bool list = target.parameter->kind == Parameter::Kind::reals;
  if (has_index && !list) throw InputError(path + ": is a single number, not a list");
  if (!list) return target;
  const bool planets = target.parameter->table == "errors";
  if (!has_index)
    throw InputError(fmt::format("{0}: is a list; name one value, as {0}[1]{1}", path, planets ? " for planet 1" : ""));
  target.index =
      parse_index(path, index, list_length(scene, *target.parameter, target.rings.empty() ? 0 : target.rings.front()),
                  planets ? ", the number of the planet" : "");
  return target;
}

std::optional<double> input_value(const Scene& scene, const InputTarget& target, std::size_t ring) {
  const Input* input = find_in(scene, target.parameter->key(), target.rings.empty() ? 0 : ring);
  if (!input) return std::nullopt;
  if (const auto* v = std::get_if<long>(&input->value)) return static_cast<double>(*v);
  if (const auto* v = std::get_if<double>(&input->value)) return *v;
  if (const auto* v = std::get_if<std::vector<double>>(&input->value); v && target.index)
    return *target.index < v->size() ? (*v)[*target.index] : 0.0;
  return std::nullopt;
}

std::vector<std::string> expand_planets(const Scene& scene, const std::string& path) {
  const auto [key, index, has_index] = split(path);
  if (!has_index || index != "*") return {path};
  std::vector<std::string> paths;
  for (int n = 1; n <= scene.stage.planets; ++n) paths.push_back(fmt::format("{}[{}]", key, n));
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

std::vector<InputEdit> resolve(const Scene& scene, const std::vector<Override>& overrides) {
  std::vector<InputEdit> edits;
  for (const auto& change : overrides) {
    const InputTarget target = find_input(scene, change.input);
    if (target.rings.empty()) edits.push_back(edit_of(scene, target, 0, change));
    for (const std::size_t ring : target.rings) edits.push_back(edit_of(scene, target, ring, change));
  }
  return edits;
}

}  // namespace annulus::app
