#include "app/scene/key_rules.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "app/scene/key_checks.h"
#include "app/scene/scene_schema.h"

namespace annulus::app {

namespace {

std::string table_of(const std::string& key) {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

std::string quoted_list(std::vector<std::string> values) {
  for (auto& value : values) value = fmt::format("\"{}\"", value);
  return listed(values, " or ");
}

/// A key as a condition of `table` names it.
std::string full_key(const std::string& key, const std::string& table) {
  return key.find('.') == std::string::npos && !table.empty() ? table + "." + key : key;
}
std::string shown_key(const std::string& key, const std::string& table) {
  return table_of(key) == table && !table.empty() ? key.substr(table.size() + 1) : key;
}

std::string joined(const std::vector<Condition>& parts, const char* between,
                   const std::function<std::string(const Condition&)>& text) {
  std::string all;
  for (const auto& part : parts) all += (all.empty() ? "" : between) + text(part);
  return all;
}

}  // namespace

KeyValues::KeyValues(const std::vector<Input>& inputs, const std::vector<Table>& tables)
    : inputs_(inputs), tables_(tables) {
  for (std::size_t i = 0; i < inputs.size(); ++i) places_.emplace(std::pair(inputs[i].key, inputs[i].entry), i);
}

const Input* KeyValues::find(const std::string& key, std::size_t entry) const {
  const auto place = places_.find({key, entry});
  return place == places_.end() ? nullptr : &inputs_[place->second];
}

bool KeyValues::given(const std::string& key, std::size_t entry) const {
  const Input* input = find(key, entry);
  return input != nullptr && input->origin == Origin::scene;
}

std::optional<std::string> KeyValues::text(const std::string& key, std::size_t entry) const {
  if (const Input* input = find(key, entry)) {
    const bool none = std::holds_alternative<std::monostate>(input->value);
    if (none && input->origin == Origin::scene) return std::nullopt;
    return none ? "" : to_text(input->value);
  }
  if (has_table(table_of(key))) return std::nullopt;  // required, and reported as missing
  const Parameter* p = find_parameter(key, tables_);
  return p ? p->without_table : "";
}

bool KeyValues::has_table(const std::string& path) const {
  const auto head = path + ".";
  for (auto next = places_.lower_bound({head, 0}); next != places_.end(); ++next) {
    const auto& key = next->first.first;
    if (!key.starts_with(head)) return false;
    if (table_of(key) == path) return true;  // not that of a table below, as [[monte_carlo.input]]
  }
  return false;
}

std::optional<bool> Condition::holds(const KeyValues& keys, const std::string& table, std::size_t entry) const {
  const auto full = full_key(key, table);
  const auto at = table_of(full) == table ? entry : 0;
  if (kind == Kind::key) return keys.given(full, at);
  if (kind == Kind::table) return keys.has_table(key);
  if (kind == Kind::value) {
    const auto value = keys.text(full, at);
    if (!value) return std::nullopt;
    return std::find(values.begin(), values.end(), *value) != values.end();
  }
  if (kind == Kind::none) {
    auto part = parts.front().holds(keys, table, entry);
    if (part) part = !*part;
    return part;
  }
  const bool decisive = kind == Kind::any;  // one part with this value decides
  std::optional<bool> result = !decisive;
  for (const auto& part : parts) {
    const auto value = part.holds(keys, table, entry);
    if (value == decisive) return decisive;
    if (!value) result = std::nullopt;
  }
  return result;
}

std::string Condition::text(const std::string& table) const {
  switch (kind) {
    case Kind::value:
      return shown_key(key, table) + " = " + quoted_list(values);
    case Kind::key:
      return shown_key(key, table);
    case Kind::table:
      return "[" + key + "]";
    case Kind::none: {
      const auto& part = parts.front();
      if (part.kind != Kind::value) return "no " + part.text(table);
      return shown_key(part.key, table) + " other than " + quoted_list(part.values);
    }
    case Kind::all:
    case Kind::any:
      break;
  }
  return joined(parts, kind == Kind::all ? " and " : " or ", [&](const Condition& c) { return c.text(table); });
}

std::string Condition::cause(const KeyValues& keys, const std::string& table, std::size_t entry) const {
  if (kind == Kind::value) {
    const auto full = full_key(key, table);
    const auto at = table_of(full) == table ? entry : 0;
    const bool implied = keys.find(full, at) == nullptr;
    return shown_key(key, table) + " = \"" + keys.text(full, at).value_or("") + "\"" +
           (implied ? " (the scene has no [" + table_of(full) + "])" : "");
  }
  if (kind == Kind::any) {
    for (const auto& part : parts)
      if (part.holds(keys, table, entry) == true) return part.cause(keys, table, entry);
  }
  if (kind != Kind::all) return text(table);
  return joined(parts, " and ", [&](const Condition& c) { return c.cause(keys, table, entry); });
}

Condition is(std::string key, std::vector<std::string> values) {
  return {.kind = Condition::Kind::value, .key = std::move(key), .values = std::move(values)};
}
Condition given(std::string key_or_table) {
  if (!key_or_table.starts_with('[')) return {.kind = Condition::Kind::key, .key = std::move(key_or_table)};
  return {.kind = Condition::Kind::table, .key = key_or_table.substr(1, key_or_table.size() - 2)};
}
Condition operator&&(Condition a, Condition b) {
  return {.kind = Condition::Kind::all, .parts = {std::move(a), std::move(b)}};
}
Condition operator||(Condition a, Condition b) {
  return {.kind = Condition::Kind::any, .parts = {std::move(a), std::move(b)}};
}
Condition operator!(Condition a) { return {.kind = Condition::Kind::none, .parts = {std::move(a)}}; }

namespace {

std::string reason_text(const KeyRule& rule) { return rule.why.empty() ? "" : ": " + rule.why; }

class RuleChecker : KeyChecks {
 public:
  RuleChecker(const std::vector<Table>& tables, Scene& scene, std::vector<Problem>& problems)
      : KeyChecks(scene, problems), tables_(tables), keys_(scene.inputs, tables) {}

  void run() {
    for (const auto& table : tables_) {
      if (!applies(table)) continue;
      for (const auto& p : table.parameters) {
        const std::string key = p.key();
        for (std::size_t entry = 0; keys_.find(key, entry) != nullptr; ++entry) check(p, entry);
      }
    }
  }

 private:
  bool applies(const Table& table) {
    if (table.only_if.empty() || !keys_.has_table(table.path)) return true;
    for (const auto& rule : table.only_if) {
      if (rule.when.holds(keys_, table.path, 0) != false) continue;
      const auto first = std::find_if(scene_.inputs.begin(), scene_.inputs.end(),
                                      [&](const Input& input) { return input.key.starts_with(table.path + "."); });
      problems_.push_back({first->line, first->column,
                           fmt::format("{}: needs {}{}", table.header(), rule.when.text(""), reason_text(rule))});
      return false;
    }
    return true;
  }

  void check(const Parameter& p, std::size_t entry) {
    if (const auto* rule = broken(p, entry)) {
      if (written(p, entry))
        problem(p.key(), entry,
                fmt::format("has a meaning only with {}{}", rule->when.text(p.table), reason_text(*rule)));
      return;
    }
    if (unknown(p, entry)) return;
    for (const auto& rule : p.refused_if) {
      if (keys_.given(p.key(), entry) && rule.when.holds(keys_, p.table, entry) == true)
        problem(p.key(), entry, fmt::format("cannot be used together with {}: {}", rule.when.text(p.table), rule.why));
    }
    if (!keys_.given(p.key(), entry)) {
      fall_back(p, entry);
      for (const auto& rule : p.required_if) {
        if (rule.when.holds(keys_, p.table, entry) != true) continue;
        problem(p.key(), entry,
                fmt::format("is required by {}{}", rule.when.cause(keys_, p.table, entry), reason_text(rule)));
        break;
      }
    }
    check_partners(p, entry);
    check_group(p, entry);
    check_alternatives(p, entry);
  }

  /// The first condition of this key that does not hold.
  [[nodiscard]] const KeyRule* broken(const Parameter& p, std::size_t entry) const {
    for (const auto& rule : p.only_if)
      if (rule.when.holds(keys_, p.table, entry) == false) return &rule;
    return nullptr;
  }
  [[nodiscard]] bool unknown(const Parameter& p, std::size_t entry) const {
    return std::any_of(p.only_if.begin(), p.only_if.end(),
                       [&](const KeyRule& rule) { return !rule.when.holds(keys_, p.table, entry).has_value(); });
  }

  /// Written with a value that makes a difference.
  [[nodiscard]] bool written(const Parameter& p, std::size_t entry) const {
    if (!keys_.given(p.key(), entry)) return false;
    const Value& value = keys_.find(p.key(), entry)->value;
    if (std::holds_alternative<std::monostate>(value)) return false;  // refused for another reason
    const bool has_default = p.presence == Parameter::Presence::defaulted && !p.default_where_it_applies;
    return !has_default || value != p.default_value;
  }

  void fall_back(const Parameter& p, std::size_t entry) {
    if (p.presence != Parameter::Presence::defaulted || !p.default_where_it_applies) return;
    set(p.key(), p.default_value, Origin::default_value, p.note, entry);
    p.store(scene_, entry, p.default_value);
  }

  void check_partners(const Parameter& p, std::size_t entry) {
    const bool has = keys_.given(p.key(), entry);
    for (const auto& name : p.together_with) {
      const auto other = p.table + "." + name;
      if (has == keys_.given(other, entry)) continue;
      problem(has ? p.key() : other, entry, fmt::format("needs {} as well", has ? other : p.key()));
    }
  }

  /// Of a group that one of its keys declares.
  void check_group(const Parameter& p, std::size_t entry) {
    if (p.one_of.empty() && p.some_of.empty()) return;
    auto group = p.one_of.empty() ? p.some_of : p.one_of;
    group.insert(group.begin(), p.name);
    std::vector<std::string> found;
    for (const auto& name : group)
      if (keys_.given(p.table + "." + name, entry)) found.push_back(name);
    if (found.empty())
      problem(p.key(), entry, fmt::format("one of {} is required", fmt::join(group, ", ")));
    else if (found.size() > 1 && !p.one_of.empty())
      problem(p.table + "." + found.back(), entry,
              fmt::format("is given beside {}; give one of {}", found.front(), fmt::join(group, ", ")));
  }

  void check_alternatives(const Parameter& p, std::size_t entry) {
    if (p.instead_of.empty()) return;
    const auto is_given = [&](const std::string& name) { return keys_.given(p.table + "." + name, entry); };
    const bool one = std::any_of(p.instead_of.begin(), p.instead_of.end(), is_given);
    const auto missing = std::find_if_not(p.instead_of.begin(), p.instead_of.end(), is_given);
    const auto others = listed(p.instead_of);
    if (is_given(p.name)) {
      if (one) problem(p.key(), entry, fmt::format("give either {} or {}", others, p.name));
    } else if (missing != p.instead_of.end()) {
      std::string by;
      for (const auto& rule : p.only_if) by += (by.empty() ? " by " : " and ") + rule.when.cause(keys_, p.table, entry);
      const bool several = p.instead_of.size() > 1;
      problem(p.table + "." + *missing, entry,
              fmt::format("{}{} or {} {} required{}", others, several ? "," : "", p.name, several ? "are" : "is", by));
    }
  }

  const std::vector<Table>& tables_;
  KeyValues keys_;
};

}  // namespace

void check_key_rules(const std::vector<Table>& tables, Scene& scene, std::vector<Problem>& problems) {
  RuleChecker(tables, scene, problems).run();
}

}  // namespace annulus::app
