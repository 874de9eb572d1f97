#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "app/scene/scene_checks.h"
#include "app/scene/scene_limits.h"
#include "app/scene/scene_schema.h"
#include "app/scene/toml/tables.h"

namespace annulus::app {

namespace {

/// Reads the tables of one file against the schema and collects every problem.
class Reader {
 public:
  Reader(const toml::table& root, const std::filesystem::path& file) : root_(root) {
    scene_.file = file;
    // Which keys there are depends on the kind; a wrong one is told about where it stands.
    const auto name = root["stage"]["kind"].value<std::string>();
    for (const auto kind : stage_kinds()) {
      if (name && *name == kind_name(kind)) kind_ = kind;
    }
  }

  Scene read() {
    check_root_keys();
    for (const auto& table : schema()) {
      if (table.applies_to(kind_)) {
        read_table(table);
      } else if (const auto* node = root_.at_path(table.path).node()) {
        problem(place_of(node->source()), fmt::format("{}: has no meaning for a stage of kind \"{}\"; it belongs to {}",
                                                      table.header(), kind_name(kind_), kinds_text(table.kinds)));
      }
    }
    if (!hopeless()) read_assumed();
    if (!hopeless()) complete_and_check(scene_, problems_);
    std::stable_sort(problems_.begin(), problems_.end(),
                     [](const Problem& a, const Problem& b) { return a.line < b.line; });
    if (!problems_.empty()) throw SceneError(scene_.file.string(), problems_);
    return std::move(scene_);
  }

 private:
  void problem(Place at, std::string message) { problems_.push_back({at.line, at.column, std::move(message)}); }
  /// A file that is no scene has something wrong in every line.
  [[nodiscard]] bool hopeless() const { return problems_.size() > most_problems; }

  void read_table(const Table& table) {
    const toml::node* node = table.path.empty() ? &root_ : root_.at_path(table.path).node();
    if (!node) {
      if (table.required) problem({}, fmt::format("{} is missing: {}", table.header(), table.meaning));
      // An absent table still has its defaults, unless its presence is itself the question ([dynamics], [mesh.*]).
      if (!table.required && !table.repeated && !needs_presence(table)) read_keys(table, toml::table{}, 0, "");
      return;
    }
    if (table.repeated) {
      const toml::array* array = node->as_array();
      if (!array || array->empty() || !array->is_homogeneous(toml::node_type::table)) {
        return problem(place_of(node->source()), fmt::format("{}: write each one as {}", table.path, table.header()));
      }
      if (array->size() > most_tables)
        return problem(place_of(node->source()), fmt::format("{}: there are {}, at most {} are possible",
                                                             table.header(), array->size(), most_tables));
      table.resize(scene_, array->size());
      for (std::size_t i = 0; i < array->size(); ++i) {
        const auto& entry = *array->get(i)->as_table();
        const bool ring = table.path == "ring";
        if (ring) scene_.rings[i].name = entry["name"].value_or(fmt::format("{}", i + 1));
        read_keys(table, entry, i, ring ? scene_.rings[i].name : "");
      }
      return;
    }
    const toml::table* entry = node->as_table();
    if (!entry) {
      return problem(place_of(node->source()),
                     fmt::format("{}: must be a table, written {}", table.path, table.header()));
    }
    read_keys(table, *entry, 0, "");
  }

  [[nodiscard]] bool needs_presence(const Table& table) const {
    if (table.on_request) return true;
    for (const auto& p : table.parameters) {
      if (p.required(kind_)) return true;
    }
    return false;
  }

  void read_keys(const Table& table, const toml::table& entry, std::size_t index, const std::string& ring) {
    if (!table.path.empty()) check_keys(table, entry);
    for (const auto& p : table.parameters) {
      if (hopeless()) return;
      Input input{.key = p.key(), .ring = ring, .unit = p.unit, .meaning = p.meaning, .entry = index};
      const auto found = entry.find(p.name);
      if (!p.applies_to(kind_)) {
        if (found == entry.end()) continue;
        problem(place_of(found->first.source()),
                fmt::format("{} = {}: has no meaning for a stage of kind \"{}\"; it belongs to {}", p.key(),
                            node_text(found->second), kind_name(kind_), kinds_text(p.kinds)));
        continue;
      }
      if (found == entry.end()) {
        const Place at = place_of(entry.source());
        if (p.required(kind_)) {
          problem(at, fmt::format("{}: is missing{}; must be {}. {}", p.key(),
                                  ring.empty() ? "" : " for ring '" + shown(ring) + "'", expected_text(p), p.meaning));
          continue;
        }
        input.origin = Origin::default_value;
        input.note = p.note;
        input.value = p.default_value;
        input.line = at.line;
        input.column = at.column;
      } else {
        const Place at = place_of(found->first.source());
        input.line = at.line;
        input.column = at.column;
        // A refused value stays in the list without a value, so that later checks do not call it missing.
        if (const auto wrong = read_value(p, found->second, input.value); !wrong.empty()) {
          problem(at, fmt::format("{} = {}: {}", p.key(), node_text(found->second), wrong));
          input.value = {};
        }
      }
      if (!std::holds_alternative<std::monostate>(input.value)) p.store(scene_, index, input.value);
      scene_.inputs.push_back(std::move(input));
    }
  }

  void check_keys(const Table& table, const toml::table& entry) {
    std::vector<std::string> names;
    for (const auto& p : table.parameters) names.push_back(p.name);
    const auto is_table = [&](const std::string& name) {
      return std::any_of(schema().begin(), schema().end(),
                         [&](const Table& t) { return t.path == table.path + "." + name; });
    };
    for (const auto& [key, node] : entry) {
      const std::string name(key.str());
      if (std::find(names.begin(), names.end(), name) != names.end() || is_table(name)) continue;
      if (hopeless()) return;
      problem(place_of(key.source()), fmt::format("{}.{} = {}: unknown key{}", table.path, shown(name), node_text(node),
                                                  suggestion(table.path, name, names)));
    }
  }

  // Nearest key of the same table; else the same key in other tables, where the user may have meant to write it.
  static std::string suggestion(const std::string& path, const std::string& name,
                                const std::vector<std::string>& names) {
    std::string elsewhere;
    for (const auto& table : schema()) {
      for (const auto& p : table.parameters) {
        if (p.name == name)
          elsewhere += (elsewhere.empty() ? "" : ", ") + (table.path.empty() ? "the top level" : table.header());
      }
    }
    if (!elsewhere.empty()) return "; it belongs in " + elsewhere;
    const std::string near = nearest(name, names);
    if (near.empty()) return "; see `annulus explain`";
    return "; did you mean " + (path.empty() ? near : path + "." + near) + "?";
  }

  void check_root_keys() {
    std::vector<std::string> names = {"assumed"};
    for (const auto& p : schema().front().parameters) names.push_back(p.name);
    for (const auto& table : schema()) {
      if (!table.path.empty()) names.push_back(table.path.substr(0, table.path.find('.')));
    }
    for (const auto& [key, node] : root_) {
      const std::string name(key.str());
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      if (hopeless()) return;
      std::string what =
          fmt::format("{}: unknown {}", shown(name), node.is_table() || node.is_array_of_tables() ? "table" : "key");
      const auto& later = unavailable_tables();
      const auto match = std::find_if(later.begin(), later.end(), [&](const auto& t) { return t.first == name; });
      if (match != later.end()) {
        what = fmt::format("[{}] ({}) is not yet available in this version", name, match->second);
      } else {
        what += suggestion("", name, names);
      }
      problem(place_of(key.source()), what);
    }
    check_mesh_names();
  }

  void check_mesh_names() {
    const auto* meshes = root_.get("mesh");
    if (!meshes) return;
    const auto* mesh = meshes->as_table();
    if (!mesh) return problem(place_of(meshes->source()), "mesh: must be a table of meshes, as [mesh.sun_planet]");
    std::vector<std::string> all, of_kind;
    for (const auto& table : schema()) {
      if (!table.path.starts_with("mesh.")) continue;
      all.push_back(table.path);
      if (table.applies_to(kind_)) of_kind.push_back(table.path);
    }
    for (const auto& [key, node] : *mesh) {
      const std::string name = "mesh." + std::string(key.str());
      if (std::find(all.begin(), all.end(), name) != all.end()) continue;
      if (hopeless()) return;
      const std::string near = nearest(name, of_kind);
      std::string list;
      for (const auto& path : of_kind) list += (list.empty() ? "" : ", ") + path;
      problem(place_of(key.source()), fmt::format("{}: unknown table; {}", shown(name),
                                                  near.empty() ? "there are " + list : "did you mean " + near + "?"));
    }
  }

  void read_assumed() {
    const auto* node = root_.get("assumed");
    if (!node) return;
    refused_ = !problems_.empty();
    if (const auto* table = node->as_table()) return read_assumed(*table, "");
    problem(place_of(node->source()), "assumed: must be a table of key = \"reason\"");
  }

  // The keys contain dots: quoted or not, they arrive here as the same path.
  void read_assumed(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      if (hopeless()) return;
      const std::string path = prefix + std::string(key.str());
      if (const auto* inner = node.as_table()) {
        read_assumed(*inner, path + ".");
        continue;
      }
      const Place at = place_of(key.source());
      const auto reason = node.value<std::string>();
      if (!reason || reason->empty()) {
        problem(at, fmt::format("assumed.{}: must be the reason, a text in quotes", shown(path)));
      } else if (const auto rule = text_rule(*reason); !rule.empty()) {
        problem(at, fmt::format("assumed.{}: {}", shown(path), rule));
      } else if (!find_parameter(path)) {
        const std::string near = nearest(path, all_keys());
        problem(at, fmt::format("assumed.{}: there is no such key{}", shown(path),
                                near.empty() ? "" : "; did you mean " + near + "?"));
      } else {
        bool has_value = false;
        for (auto& input : scene_.inputs) {
          if (input.key != path || std::holds_alternative<std::monostate>(input.value)) continue;
          input.assumed = *reason;
          has_value = true;
        }
        scene_.assumed[path] = *reason;
        // A key that was refused is not set either, and its problem is told already.
        if (!has_value && !refused_) problem(at, fmt::format("assumed.{}: this scene does not set it", shown(path)));
      }
    }
  }

  const toml::table& root_;
  StageKind kind_ = StageKind::planetary;
  Scene scene_;
  std::vector<Problem> problems_;
  bool refused_ = false;  ///< something had a problem before [assumed] was read
};

}  // namespace

Scene read_tables(const toml::table& root, const std::filesystem::path& file) { return Reader(root, file).read(); }

Scene parse_scene(const std::string& text, const std::filesystem::path& name) {
  check_scene_text(text, name.string());
  toml::table root;
  try {
    root = toml::parse(text, name.string());
  } catch (const toml::parse_error& error) {
    const Place at = place_of(error.source());
    throw SceneError(name.string(), {{at.line, at.column, "not valid TOML: " + std::string(error.description())}});
  }
  Scene scene = read_tables(root, name);
  scene.text = text;
  return scene;
}

Scene read_scene(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw InputError(file.string() + ": cannot be read; is the path right?");
  std::string text(largest_scene + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return parse_scene(text, file);
}

}  // namespace annulus::app
