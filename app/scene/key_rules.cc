#include "app/scene/key_rules.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scene/scene_limits.h"

namespace annulus::app {

namespace {

std::string reason_text(const KeyRule& rule) { return rule.why.empty() ? "" : ": " + rule.why; }

class RuleChecker {
 public:
  RuleChecker(const std::vector<Table>& tables, Scene& scene, std::vector<Problem>& problems)
      : tables_(tables), scene_(scene), problems_(problems), keys_(scene.inputs, tables) {}

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
        problem(p, entry, fmt::format("has a meaning only with {}{}", rule->when.text(p.table), reason_text(*rule)));
      return;
    }
    if (unknown(p, entry)) return;
    for (const auto& rule : p.refused_if) {
      if (keys_.given(p.key(), entry) && rule.when.holds(keys_, p.table, entry) == true)
        problem(p, entry, fmt::format("cannot stand beside {}: {}", rule.when.text(p.table), rule.why));
    }
    if (!keys_.given(p.key(), entry)) {
      fall_back(p, entry);
      for (const auto& rule : p.required_if) {
        if (rule.when.holds(keys_, p.table, entry) != true) continue;
        problem(p, entry,
                fmt::format("is required by {}{}", rule.when.cause(keys_, p.table, entry), reason_text(rule)));
        break;
      }
    }
    check_partners(p, entry);
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
    for (auto& input : scene_.inputs) {
      if (input.entry != entry || input.key != p.key()) continue;
      input.value = p.default_value;
      input.note = p.note;
      p.store(scene_, entry, input.value);
      return;
    }
  }

  void check_partners(const Parameter& p, std::size_t entry) {
    const bool has = keys_.given(p.key(), entry);
    for (const auto& name : p.together_with) {
      const auto other = p.table + "." + name;
      if (has == keys_.given(other, entry)) continue;
      problem(has ? p.key() : other, entry, fmt::format("needs {} as well", has ? other : p.key()));
    }
  }

  void check_alternatives(const Parameter& p, std::size_t entry) {
    if (p.instead_of.empty()) return;
    const auto is_given = [&](const std::string& name) { return keys_.given(p.table + "." + name, entry); };
    const bool one = std::any_of(p.instead_of.begin(), p.instead_of.end(), is_given);
    const auto missing = std::find_if_not(p.instead_of.begin(), p.instead_of.end(), is_given);
    const auto others = listed(p.instead_of);
    if (is_given(p.name)) {
      if (one) problem(p, entry, fmt::format("give either {} or {}", others, p.name));
    } else if (missing != p.instead_of.end()) {
      std::string by;
      for (const auto& rule : p.only_if) by += (by.empty() ? " by " : " and ") + rule.when.cause(keys_, p.table, entry);
      const bool several = p.instead_of.size() > 1;
      problem(p.table + "." + *missing, entry,
              fmt::format("{}{} or {} {} required{}", others, several ? "," : "", p.name, several ? "are" : "is", by));
    }
  }

  void problem(const Parameter& p, std::size_t entry, const std::string& rule) { problem(p.key(), entry, rule); }
  void problem(const std::string& key, std::size_t entry, const std::string& rule) {
    const Input* input = keys_.find(key, entry);
    std::string head = key;
    if (input && input->origin == Origin::scene) head += " = " + shown(to_text(input->value));
    if (input && !input->ring.empty()) head += " (ring '" + shown(input->ring) + "')";
    problems_.push_back({input ? input->line : 0, input ? input->column : 0, head + ": " + rule});
  }

  const std::vector<Table>& tables_;
  Scene& scene_;
  std::vector<Problem>& problems_;
  KeyValues keys_;
};

}  // namespace

void check_key_rules(const std::vector<Table>& tables, Scene& scene, std::vector<Problem>& problems) {
  RuleChecker(tables, scene, problems).run();
}

}  // namespace annulus::app
