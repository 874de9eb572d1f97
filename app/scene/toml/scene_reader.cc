#include <fmt/format.h>

#include <algorithm>

#include "app/scene/key_checks.h"
#include "app/scene/scene_kind.h"
#include "app/scene/scene_limits.h"
#include "app/scene/toml/values.h"

namespace annulus::app {

namespace {

/// Reads the tables of one file against the schema and collects every problem.
class Reader {
 public:
  Reader(const toml::table& root, const std::filesystem::path& file, const std::vector<Table>* tables)
      : root_(root), is_scene_(!tables), all_(tables ? *tables : schema()) {
    scene_.file = file;
    // Which keys there are depends on the kind; a wrong one is reported where its value is read.
    const auto name = root["stage"]["kind"].value<std::string>();
    for (const auto& kind : scene_kinds()) {
      if (name && *name == kind.name) kind_ = &kind;
    }
    scene_.stage.kind = kind_->name;
    own_ = tables ? tables : &schema(kind_->name);
  }

  Scene read() {
    check_root_keys();
    for (const auto& table : *own_) read_table(table);
    for (const auto& table : all_)
      if (!table.applies_to(kind_->name)) refuse_table(table);
    if (is_scene_ && !hopeless()) read_assumed();
    if (is_scene_ && !hopeless()) complete_and_check();
    std::stable_sort(problems_.begin(), problems_.end(),
                     [](const Problem& a, const Problem& b) { return a.line < b.line; });
    if (!problems_.empty()) throw SceneError(scene_.file.string(), problems_);
    return std::move(scene_);
  }

 private:
  void problem(const toml::source_region& at, std::string message) {
    problems_.push_back({static_cast<int>(at.begin.line), static_cast<int>(at.begin.column), std::move(message)});
  }
  /// A file that is no scene has something wrong in every line.
  [[nodiscard]] bool hopeless() const { return problems_.size() > most_problems; }

  /// Conditional defaults, lists of one value per planet, derived values; the rules between keys.
  void complete_and_check() {
    check_key_rules(*own_, scene_, problems_);
    kind_->check(scene_, problems_);
    // Paths are looked up among the inputs, which have to be right for that.
    if (problems_.empty()) check_study_keys(scene_, problems_);
  }

  /// A table of other kinds.
  void refuse_table(const Table& table) {
    if (const auto* node = root_.at_path(table.path).node())
      problem(node->source(), fmt::format("{}: has no meaning for a stage of kind \"{}\"; it belongs to {}",
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
        return problem(node->source(), fmt::format("{}: write each one as {}", table.path, table.header()));
      }
      if (array->size() > most_tables)
        return problem(node->source(), fmt::format("{}: there are {}, at most {} are possible", table.header(),
                                                   array->size(), most_tables));
      table.resize(scene_, array->size());
      for (std::size_t i = 0; i < array->size(); ++i) {
        const auto& entry = *array->get(i)->as_table();
        // One without a name, which is a problem, is named by its number.
        read_keys(table, entry, i, table.variants ? entry["name"].value_or(fmt::format("{}", i + 1)) : "");
      }
      return;
    }
    const toml::table* entry = node->as_table();
    if (!entry) {
      return problem(node->source(), fmt::format("{}: must be a table, written {}", table.path, table.header()));
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
    if (const auto* other = find_parameter(key, all_))
      return fmt::format("has no meaning for a stage of kind \"{}\"; it belongs to {}: leave it out", kind_->name,
                         listed(other->kinds));
    const auto now = renamed_key(key);
    return now.empty() ? "" : fmt::format("is now `{}`", now);
  }

  void read_keys(const Table& table, const toml::table& entry, std::size_t index, const std::string& variant) {
    if (!table.path.empty()) check_keys(table, entry);
    for (const auto& p : table.parameters) {
      if (hopeless()) return;
      Input input{.key = p.key(), .variant = variant, .unit = p.unit, .meaning = p.meaning, .entry = index};
      const auto found = entry.find(p.name);
      const auto& at = found == entry.end() ? entry.source() : found->first.source();
      input.line = static_cast<int>(at.begin.line);
      input.column = static_cast<int>(at.begin.column);
      if (found != entry.end()) {
        // A refused value stays in the list without a value, so that later checks do not call it missing.
        if (const auto wrong = read_value(p, found->second, input.value); !wrong.empty()) {
          problem(at, fmt::format("{} = {}: {}", p.key(), node_text(found->second), wrong));
          input.value = {};
        }
      } else if (p.required(kind_->name)) {
        problem(at, fmt::format("{}: is missing{}; must be {}. {}", p.key(),
                                variant.empty() ? "" : fmt::format(" for {} '{}'", table.path, shown(variant)),
                                expected_text(p), p.meaning));
        continue;
      } else {
        input.origin = Origin::default_value;
        input.note = p.note;
        if (!p.default_where_it_applies)
          input.value = p.default_value;  // the others follow with the rules between keys
      }
      if (!std::holds_alternative<std::monostate>(input.value)) store(p, index, input, at);
      scene_.inputs.push_back(std::move(input));
    }
  }

  void store(const Parameter& p, std::size_t index, const Input& input, const toml::source_region& at) {
    try {
      p.store(scene_, index, input.value);
    } catch (const InputError& error) {
      const auto of = input.variant.empty() ? "" : fmt::format(" ({} '{}')", p.table, shown(input.variant));
      problem(at, fmt::format("{} = {}{}: {}", p.key(), shown(to_text(input.value)), of, error.what()));
    }
  }

  /// Reports every key that is none of `names`.
  template <class Text>
  void refuse_others(const toml::table& table, const std::vector<std::string>& names, Text text) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      if (hopeless()) return;
      problem(key.source(), text(name, node));
    }
  }

  void check_keys(const Table& table, const toml::table& entry) {
    std::vector<std::string> names;
    for (const auto& p : table.parameters) names.push_back(p.name);
    for (const auto& below : all_)
      if (below.path.starts_with(table.path + ".")) names.push_back(below.path.substr(table.path.size() + 1));
    refuse_others(entry, names, [&](const std::string& name, const toml::node& node) {
      const auto refused = refusal(table, name);
      return fmt::format("{}.{} = {}: {}", table.path, shown(name), node_text(node),
                         refused.empty() ? "unknown key" + suggestion(table.path, name, names) : refused);
    });
  }

  // Nearest key of the same table; else the same key in other tables, where the user may have meant to write it.
  [[nodiscard]] std::string suggestion(const std::string& path, const std::string& name,
                                       const std::vector<std::string>& names) const {
    std::string elsewhere;
    for (const auto& table : *own_)
      if (table.find(name))
        elsewhere += (elsewhere.empty() ? "" : ", ") + (table.path.empty() ? "the top level" : table.header());
    if (!elsewhere.empty()) return "; it belongs in " + elsewhere;
    const std::string near = nearest(name, names);
    if (near.empty()) return "; see `annulus explain`";
    return "; did you mean " + (path.empty() ? near : path + "." + near) + "?";
  }

  void check_root_keys() {
    std::vector<std::string> names;
    if (is_scene_) names.emplace_back("assumed");
    for (const auto& p : all_.front().parameters) names.push_back(p.name);
    for (const auto& table : all_)
      if (!table.path.empty()) names.push_back(table.path.substr(0, table.path.find('.')));
    refuse_others(root_, names, [&](const std::string& name, const toml::node& node) {
      if (const auto refused = refusal(all_.front(), name); !refused.empty())
        return fmt::format("{} = {}: {}", shown(name), node_text(node), refused);
      for (const auto& [later, what] : unavailable_tables())
        if (later == name) return fmt::format("[{}] ({}) is not yet available in this version", name, what);
      return fmt::format("{}: unknown {}{}", shown(name),
                         node.is_table() || node.is_array_of_tables() ? "table" : "key", suggestion("", name, names));
    });
    check_mesh_names();
  }

  void check_mesh_names() {
    const auto* meshes = root_.get("mesh");
    if (!meshes) return;
    const auto* mesh = meshes->as_table();
    if (!mesh) return problem(meshes->source(), "mesh: must be a table of meshes, as [mesh.sun_planet]");
    std::vector<std::string> all, of_kind;
    for (const auto& table : all_) {
      if (!table.path.starts_with("mesh.")) continue;
      all.push_back(table.path.substr(5));
      if (table.applies_to(kind_->name)) of_kind.push_back(table.path);
    }
    refuse_others(*mesh, all, [&](const std::string& name, const toml::node&) {
      return fmt::format(
          "mesh.{}: unknown table{}", shown(name),
          did_you_mean("mesh." + name, of_kind, fmt::format("; there are {}", fmt::join(of_kind, ", "))));
    });
  }

  void read_assumed() {
    const auto* node = root_.get("assumed");
    if (!node) return;
    refused_ = !problems_.empty();
    if (const auto* table = node->as_table()) return read_assumed(*table, "");
    problem(node->source(), "assumed: must be a table of key = \"reason\"");
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
      const auto& at = key.source();
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
    return "there is no such key" + did_you_mean(path, all_keys());
  }

  const toml::table& root_;
  bool is_scene_;
  const std::vector<Table>& all_;            ///< of all kinds
  const std::vector<Table>* own_ = nullptr;  ///< of this one
  const SceneKind* kind_ = &scene_kinds().front();
  Scene scene_;
  std::vector<Problem> problems_;
  bool refused_ = false;  ///< something had a problem before [assumed] was read
};

}  // namespace

Scene read_tables(const toml::table& root, const std::filesystem::path& file, const std::vector<Table>* tables) {
  return Reader(root, file, tables).read();
}

Scene parse_scene(const std::string& text, const std::filesystem::path& name) {
  Scene scene = read_tables(parse_toml(text, name.string()), name);
  scene.text = text;
  return scene;
}

Scene read_scene(const std::filesystem::path& file) { return parse_scene(text_of_file(file), file); }

}  // namespace annulus::app
