#include "app/scene/scene_schema.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "app/scene/common_tables.h"
#include "app/scene/scene_kind.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

template <class List>
auto by_path(List& tables, const std::string& path) {
  return std::find_if(tables.begin(), tables.end(), [&](const Table& t) { return t.path == path; });
}

template <class List>
auto by_name(List& parameters, const std::string& name) {
  return std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.name == name; });
}

/// Leaves out what belongs to gears.
void drop_gears(std::vector<Table>& tables) {
  tables.erase(by_path(tables, "material"));
  auto& top = by_path(tables, "")->parameters;
  top.erase(by_name(top, "model"));
  auto& stage = by_path(tables, "stage")->parameters;
  stage.erase(std::remove_if(stage.begin(), stage.end(), [](const Parameter& p) { return p.name != "kind"; }),
              stage.end());
}
void drop_meshes(std::vector<Table>& tables) {
  auto& dynamics = by_path(tables, "dynamics")->parameters;
  for (const auto* name : {"half_backlash_um", "mesh_damping_ratio", "modal_damping_ratio", "rayleigh_mass_per_s",
                           "rayleigh_stiffness_s", "mesh_damping", "load_dependence"})
    dynamics.erase(by_name(dynamics, name));
}

/// The common tables with the keys of one kind added, its own tables between them.
std::vector<Table> tables_of(const SceneKind& kind) {
  auto tables = first_common_tables();
  if (!kind.gears) drop_gears(tables);
  auto own = static_cast<std::ptrdiff_t>(tables.size());
  auto last = last_common_tables();
  if (!kind.gears) drop_meshes(last);
  std::move(last.begin(), last.end(), std::back_inserter(tables));
  for (auto& table : kind.tables()) {
    const auto common = by_path(tables, table.path);
    if (common == tables.end())
      tables.insert(tables.begin() + own++, std::move(table));
    else
      std::move(table.parameters.begin(), table.parameters.end(), std::back_inserter(common->parameters));
  }
  return tables;
}

/// Adds the rules of another kind. A rule of all of them has no list of kinds.
void add_rules(std::vector<KeyRule>& rules, const std::vector<KeyRule>& more, const std::string& table,
               const std::string& kind) {
  for (const auto& rule : more) {
    const auto known = std::find_if(rules.begin(), rules.end(), [&](const KeyRule& r) {
      return r.when.text(table) == rule.when.text(table) && r.why == rule.why;
    });
    auto& there = known == rules.end() ? rules.emplace_back(rule) : *known;
    there.kinds.push_back(kind);
  }
}

/// The keys of all kinds together, for the reference and for look-ups by key.
class Union {
 public:
  void add(const SceneKind& kind) {
    ++kinds_;
    for (const auto& table : schema(kind.name)) {
      auto known = by_path(tables_, table.path);
      if (known == tables_.end()) {
        tables_.push_back(table);
        known = std::prev(tables_.end());
        known->parameters.clear();
      }
      known->kinds.push_back(kind.name);
      for (const auto& p : table.parameters) add(*known, p, kind.name);
    }
  }

  std::vector<Table> done() {
    // Lists of kinds stay where they restrict something.
    for (auto& table : tables_) {
      for (auto& p : table.parameters) {
        for (auto* rules : {&p.only_if, &p.required_if, &p.refused_if})
          for (auto& rule : *rules)
            if (rule.kinds.size() == p.kinds.size()) rule.kinds.clear();
        if (p.presence == Parameter::Presence::required && p.required_for.size() < p.kinds.size())
          p.presence = Parameter::Presence::optional;
        if (p.required_for.size() == p.kinds.size()) p.required_for.clear();
        if (p.kinds.size() == table.kinds.size()) p.kinds.clear();
      }
      if (table.kinds.size() == kinds_) table.kinds.clear();
    }
    // Tables of one kind stand before those that end every scene.
    const auto last = last_common_tables();
    std::stable_partition(tables_.begin(), tables_.end(),
                          [&](const Table& table) { return by_path(last, table.path) == last.end(); });
    return std::move(tables_);
  }

 private:
  static void add(Table& table, const Parameter& p, const std::string& kind) {
    auto known = by_name(table.parameters, p.name);
    if (known == table.parameters.end()) {
      table.parameters.push_back(p);
      known = std::prev(table.parameters.end());
      for (auto* rules : {&known->only_if, &known->required_if, &known->refused_if}) rules->clear();
    }
    known->kinds.push_back(kind);
    if (p.presence == Parameter::Presence::required) known->required_for.push_back(kind);
    if (known->note.empty()) known->note = p.note;
    for (const auto& choice : p.choices)
      if (std::find(known->choices.begin(), known->choices.end(), choice) == known->choices.end())
        known->choices.push_back(choice);
    add_rules(known->only_if, p.only_if, table.path, kind);
    add_rules(known->required_if, p.required_if, table.path, kind);
    add_rules(known->refused_if, p.refused_if, table.path, kind);
  }

  std::vector<Table> tables_;
  std::size_t kinds_ = 0;
};

std::vector<Table> all_tables() {
  Union all;
  for (const auto& kind : scene_kinds()) all.add(kind);
  return all.done();
}

std::map<std::string, std::vector<Table>> tables_by_kind() {
  std::map<std::string, std::vector<Table>> tables;
  for (const auto& kind : scene_kinds()) tables[kind.name] = tables_of(kind);
  return tables;
}

}  // namespace

const SceneKind& scene_kind(const std::string& name) {
  const auto& kinds = scene_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const SceneKind& k) { return k.name == name; });
  require(found != kinds.end(), "a kind of gear system is registered by name");
  return *found;
}

const std::vector<Table>& schema() {
  static const std::vector<Table> tables = all_tables();
  return tables;
}

const std::vector<Table>& schema(const std::string& kind) {
  static const auto tables = tables_by_kind();
  return tables.at(scene_kind(kind).name);
}

const std::vector<std::pair<std::string, std::string>>& unavailable_tables() {
  static const std::vector<std::pair<std::string, std::string>> tables = {
      {"modes", "choice of vibration modes"},
  };
  return tables;
}

}  // namespace annulus::app
