#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "app/scene/scene_checks.h"
#include "app/scene/scene_kind.h"
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
    // Which keys there are depends on the kind; a wrong one is reported where its value is read.
    const auto name = root["stage"]["kind"].value<std::string>();
    for (const auto& kind : scene_kinds()) {
      if (name && *name == kind.name) kind_ = &kind;
    }
    scene_.stage.kind = kind_->name;
  }

  Scene read() {
    check_root_keys();
    for (const auto& table : schema(kind_->name)) read_table(table);
    for (const auto& table : schema()) {
      if (!table.applies_to(kind_->name)) refuse_table(table);
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

  /// A table of other kinds.
  void refuse_table(const Table& table) {
    if (const auto* node = root_.at_path(table.path).node())
      problem(place_of(node->source()), fmt::format("{}: has no meaning for a stage of kind \"{}\"; it belongs to {}",
                                                    table.header(), kind_->name, listed(table.kinds)));
  }

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
    return std::any_of(table.parameters.begin(), table.parameters.end(),
                       [&](const Parameter& p) { return p.required(kind_->name); });
  }

  /// What is wrong with a key that only other kinds have, or with an earlier name; empty for all other words.
  [[nodiscard]] std::string refusal(const Table& table, const std::string& name) const {
    const std::string key = table.path.empty() ? name : table.path + "." + name;
    if (const auto* other = find_parameter(key))
      return fmt::format("has no meaning for a stage of kind \"{}\"; it belongs to {}: leave it out", kind_->name,
                         listed(other->kinds));
    const auto now = renamed_key(key);
    return now.empty() ? "" : fmt::format("is now `{}`", now);
  }

  void read_keys(const Table& table, const toml::table& entry, std::size_t index, const std::string& ring) {
    if (!table.path.empty()) check_keys(table, entry);
    for (const auto& p : table.parameters) {
      if (hopeless()) return;
      Input input{.key = p.key(), .ring = ring, .unit = p.unit, .meaning = p.meaning, .entry = index};
      const auto found = entry.find(p.name);
      if (found == entry.end()) {
        const Place at = place_of(entry.source());
        if (p.required(kind_->name)) {
          problem(at, fmt::format("{}: is missing{}; must be {}. {}", p.key(),
                                  ring.empty() ? "" : " for ring '" + shown(ring) + "'", expected_text(p), p.meaning));
          continue;
        }
        input.origin = Origin::default_value;
        input.note = p.note;
        if (!p.default_where_it_applies)
          input.value = p.default_value;  // the others follow with the rules between keys
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
      const auto refused = refusal(table, name);
      problem(place_of(key.source()),
              fmt::format("{}.{} = {}: {}", table.path, shown(name), node_text(node),
                          refused.empty() ? "unknown key" + suggestion(table.path, name, names) : refused));
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
      if (const auto refused = refusal(schema().front(), name); !refused.empty()) {
        what = fmt::format("{} = {}: {}", shown(name), node_text(node), refused);
      } else if (match != later.end()) {
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
      if (table.applies_to(kind_->name)) of_kind.push_back(table.path);
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
        problem(at, fmt::format("assumed.{}: {}", shown(path), unknown_key(path)));
      } else {
        bool has_value = false;
        for (auto& input : scene_.inputs) {
          if (input.key != path || std::holds_alternative<std::monostate>(input.value)) continue;
          input.assumed = *reason;
          has_value = true;
        }
        scene_.assumed[path] = *reason;
        // A key that was refused is not set either, and its problem is reported already.
        if (!has_value && !refused_) problem(at, fmt::format("assumed.{}: this scene does not set it", shown(path)));
      }
    }
  }

  static std::string unknown_key(const std::string& path) {
    if (const auto now = renamed_key(path); !now.empty()) return fmt::format("is now `{}`", now);
    const std::string near = nearest(path, all_keys());
    return "there is no such key" + (near.empty() ? "" : "; did you mean " + near + "?");
  }

  const toml::table& root_;
  const SceneKind* kind_ = &scene_kinds().front();
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
