#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "app/scene/scene_kind.h"
#include "app/scene/scene_schema.h"

namespace annulus::app {

const Table* find_table(const std::string& path, const std::vector<Table>& tables) {
  const auto found = std::find_if(tables.begin(), tables.end(), [&](const Table& t) { return t.path == path; });
  return found == tables.end() ? nullptr : &*found;
}

const Parameter* Table::find(const std::string& name) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

const Parameter* find_parameter(const std::string& key, const std::vector<Table>& tables) {
  const auto dot = key.rfind('.');
  const Table* table = find_table(dot == std::string::npos ? "" : key.substr(0, dot), tables);
  return table ? table->find(key.substr(dot + 1)) : nullptr;
}

std::string renamed_key(const std::string& old_key) {
  for (const auto& table : schema())
    for (const auto& p : table.parameters)
      for (const auto& old : p.old_names)
        if (old_key == (table.path.empty() ? old : table.path + "." + old)) return p.key();
  return "";
}

std::vector<std::string> all_keys() {
  std::vector<std::string> keys;
  for (const auto& table : schema())
    for (const auto& p : table.parameters) keys.push_back(p.key());
  return keys;
}

const std::vector<std::string>& stage_kinds() {
  static const std::vector<std::string> kinds = [] {
    std::vector<std::string> list;
    for (const auto& kind : scene_kinds()) list.push_back(kind.name);
    return list;
  }();
  return kinds;
}

std::string listed(const std::vector<std::string>& names, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + names[i];
  return text;
}

namespace {

bool among(const std::string& kind, const std::vector<std::string>& kinds) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

/// "only with structure = "pinned" or "bolted" (planetary): why"
std::string rule_text(const char* verb, const KeyRule& rule, const std::string& table) {
  return verb + rule.when.text(table) + (rule.kinds.empty() ? "" : " (" + listed(rule.kinds) + ")") +
         (rule.why.empty() ? "" : ": " + rule.why);
}

std::string as_sentence(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text + ".";
}

/// Rules with the same condition as another one, as those of needed_if.
bool has_condition_of(const KeyRule& rule, const std::vector<KeyRule>& others, const std::string& table) {
  return std::any_of(others.begin(), others.end(),
                     [&](const KeyRule& o) { return o.when.text(table) == rule.when.text(table); });
}

}  // namespace

bool is_study_table(const std::string& path) {
  const Table* table = find_table(path);
  return table && table->role == Table::Role::study;
}

bool Table::applies_to(const std::string& kind) const { return kinds.empty() || among(kind, kinds); }
bool Parameter::applies_to(const std::string& gear_system) const { return kinds.empty() || among(gear_system, kinds); }
bool Parameter::required(const std::string& gear_system) const {
  return applies_to(gear_system) && (presence == Presence::required || among(gear_system, required_for));
}

std::vector<std::string> rule_texts(const Parameter& p) {
  std::vector<std::string> list;
  for (const auto& rule : p.only_if) {
    const bool needed = has_condition_of(rule, p.required_if, p.table);
    list.push_back(rule_text(needed ? "required, and permitted only, with " : "only with ", rule, p.table));
  }
  for (const auto& rule : p.required_if)
    if (!has_condition_of(rule, p.only_if, p.table)) list.push_back(rule_text("required by ", rule, p.table));
  for (const auto& rule : p.refused_if) list.push_back(rule_text("refused beside ", rule, p.table));
  for (const auto& name : p.together_with) list.push_back("together with " + name);
  if (!p.one_of.empty()) list.push_back(fmt::format("exactly one of this, {}", listed(p.one_of)));
  if (!p.some_of.empty()) list.push_back(fmt::format("at least one of this, {}", listed(p.some_of)));
  if (!p.instead_of.empty()) list.push_back("either this or " + listed(p.instead_of));
  return list;
}

std::string choices_text(const Parameter& p) { return fmt::format("one of \"{}\"", fmt::join(p.choices, "\", \"")); }

std::string Parameter::type_text() const {
  static const std::map<Kind, std::string> texts = {{Kind::integer, "a whole number"},
                                                    {Kind::real, "a number"},
                                                    {Kind::text, "a text in quotes"},
                                                    {Kind::reals, "a list of numbers"},
                                                    {Kind::texts, "a list of texts in quotes"}};
  return kind == Kind::choice ? choices_text(*this) : texts.at(kind);
}

bool Parameter::in_range(double x) const {
  if (std::isnan(x)) return false;
  if (std::isinf(x)) return x > 0 && may_be_infinite;
  return (low_included ? x >= low : x > low) && x <= high;
}

std::string Parameter::range_text() const {
  const bool has_low = low > -rigid, has_high = high < rigid;
  if (!has_low && !has_high) return "";
  std::string text;
  if (has_low) text += to_text(low) + (low_included ? " <= " : " < ");
  text += kind == Kind::reals ? "each value" : "value";
  if (has_high) text += " <= " + to_text(high);
  if (!unit.empty()) text += " " + unit;
  if (may_be_infinite && words.empty()) text += ", or inf";
  for (const auto& [word, value] : words) text += fmt::format(", or \"{}\"", word);
  return text;
}

std::string presence_text(const Parameter& p) {
  if (p.presence == Parameter::Presence::required) return "required";
  if (p.presence == Parameter::Presence::optional) {
    const std::string kinds = p.required_for.empty() ? "" : "required for " + listed(p.required_for) + ", else ";
    const std::string word = p.required_if.empty() ? "optional" : "conditional";
    return kinds + (p.note.empty() ? word : word + "; absent: " + p.note);
  }
  const std::string value = p.kind == Parameter::Kind::choice || p.kind == Parameter::Kind::text
                                ? '"' + to_text(p.default_value) + '"'
                                : to_text(p.default_value);
  if (value == "[]") return "default " + p.note;
  return "default " + value + (p.note.empty() ? "" : " (" + p.note + ")");
}

std::string expected_text(const Parameter& p) {
  const auto range = p.range_text();
  return p.type_text() + (p.unit.empty() ? "" : " in " + p.unit) + (range.empty() ? "" : ", " + range);
}

std::string explain(const Parameter& p) {
  std::string text = p.key() + "\n  " + p.meaning + "\n  " + expected_text(p) + "\n  " + presence_text(p) + "\n";
  for (const auto& rule : rule_texts(p)) text += "  " + rule + "\n";
  if (!p.kinds.empty()) text += "  for stages of kind " + listed(p.kinds) + "\n";
  return text;
}

std::string scene_reference() {
  std::string text =
      "# Scene reference\n\n"
      "Written by `annulus explain --markdown`; the declarations are the `*_table*.cc` below `app/scene` and "
      "`app/systems`.\n"
      "A scene is a TOML file. Every key carries its unit.\n";
  for (const auto& table : schema()) {
    text += fmt::format("\n## {}\n\n{}", table.path.empty() ? "Top level" : "`" + table.header() + "`", table.meaning);
    if (!table.required) text += " Optional.";
    for (const auto& rule : table.only_if) text += " " + as_sentence(rule_text("only with ", rule, ""));
    if (!table.kinds.empty()) text += " For stages of kind " + listed(table.kinds) + ".";
    text += "\n\n| key | type | range | presence | meaning |\n|---|---|---|---|---|\n";
    for (const auto& p : table.parameters) {
      std::string rules;
      for (const auto& rule : rule_texts(p)) rules += "; " + rule;
      text += fmt::format("| `{}` | {} | {} | {}{} | {}{} |\n", p.name, p.type_text(), p.range_text(), presence_text(p),
                          rules, p.meaning, p.kinds.empty() ? "" : " For " + listed(p.kinds) + ".");
    }
  }
  text +=
      "\n## `[assumed]`\n\nInputs that no source gives, as `key = \"reason\"`; each is shown with its reason in the "
      "plan "
      "and the report.\nOptional.\n\n    [assumed]\n    ring.free_length_mm = \"fits the extra mass of the thin-walled "
      "ring\"\n\n## Not yet available\n\n";
  for (const auto& [name, what] : unavailable_tables()) text += fmt::format("- `[{}]`: {}\n", name, what);
  return text;
}

}  // namespace annulus::app
