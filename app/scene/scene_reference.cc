#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scene/scene_schema.h"

namespace annulus::app {

const Parameter* find_parameter(const std::string& key) {
  for (const auto& table : schema()) {
    for (const auto& p : table.parameters) {
      if (p.key() == key) return &p;
    }
  }
  return nullptr;
}

std::vector<std::string> all_keys() {
  std::vector<std::string> keys;
  for (const auto& table : schema()) {
    for (const auto& p : table.parameters) keys.push_back(p.key());
  }
  return keys;
}

const std::vector<StageKind>& stage_kinds() {
  static const std::vector<StageKind> kinds = {StageKind::planetary, StageKind::helical_pair, StageKind::two_k_v};
  return kinds;
}

const char* kind_name(StageKind kind) {
  switch (kind) {
    case StageKind::planetary:
      return "planetary";
    case StageKind::helical_pair:
      return "helical_pair";
    case StageKind::two_k_v:
      break;
  }
  return "two_k_v";
}

std::string kinds_text(const std::vector<StageKind>& kinds) {
  std::string text;
  for (std::size_t i = 0; i < kinds.size(); ++i)
    text += (i == 0 ? "" : i + 1 == kinds.size() ? " and " : ", ") + std::string(kind_name(kinds[i]));
  return text;
}

namespace {
bool among(StageKind kind, const std::vector<StageKind>& kinds) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}
}  // namespace

bool is_study_table(const std::string& path) {
  for (const std::string study : {"sweep", "grid", "monte_carlo", "sensitivity", "optimise"}) {
    if (path == study || path.starts_with(study + ".")) return true;
  }
  return false;
}

bool Table::applies_to(StageKind kind) const { return kinds.empty() || among(kind, kinds); }
bool Parameter::applies_to(StageKind stage) const { return kinds.empty() || among(stage, kinds); }
bool Parameter::required(StageKind stage) const {
  return applies_to(stage) && (presence == Presence::required || among(stage, required_for));
}

std::string Parameter::type_text() const {
  switch (kind) {
    case Kind::integer:
      return "a whole number";
    case Kind::real:
      return "a number";
    case Kind::text:
      return "a text in quotes";
    case Kind::reals:
      return "a list of numbers";
    case Kind::texts:
      return "a list of texts in quotes";
    case Kind::choice:
      break;
  }
  std::string text = "one of";
  for (const auto& c : choices) text += (c == choices.front() ? " \"" : ", \"") + c + "\"";
  return text;
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
  if (may_be_infinite) text += ", or inf";
  return text;
}

std::string presence_text(const Parameter& p) {
  switch (p.presence) {
    case Parameter::Presence::required:
      return "required";
    case Parameter::Presence::optional: {
      const std::string kinds = p.required_for.empty() ? "" : "required for " + kinds_text(p.required_for) + ", else ";
      return kinds + (p.note.empty() ? "optional" : "optional; absent: " + p.note);
    }
    case Parameter::Presence::defaulted:
      break;
  }
  const auto* list = std::get_if<std::vector<double>>(&p.default_value);
  const auto* texts = std::get_if<std::vector<std::string>>(&p.default_value);
  const auto* text = std::get_if<std::string>(&p.default_value);
  std::string value = text ? "\"" + *text + "\"" : to_text(p.default_value);
  if ((list && list->empty()) || (texts && texts->empty())) return "default " + p.note;
  return "default " + value + (p.note.empty() ? "" : " (" + p.note + ")");
}

std::string explain(const Parameter& p) {
  std::string text = p.key() + "\n  " + p.meaning + "\n  " + p.type_text();
  if (!p.unit.empty()) text += " in " + p.unit;
  if (const auto range = p.range_text(); !range.empty()) text += "; " + range;
  text += "\n  " + presence_text(p) + "\n";
  if (!p.kinds.empty()) text += "  for stages of kind " + kinds_text(p.kinds) + "\n";
  return text;
}

std::string scene_reference() {
  std::string text =
      "# Scene reference\n\n"
      "Written by `annulus explain --markdown`; the declarations are in `app/scene/scene_schema.cc`.\n"
      "A scene is a TOML file. Every key carries its unit.\n";
  for (const auto& table : schema()) {
    text += fmt::format("\n## {}\n\n{}", table.path.empty() ? "Top level" : "`" + table.header() + "`", table.meaning);
    if (!table.required) text += " Optional.";
    if (!table.kinds.empty()) text += " For stages of kind " + kinds_text(table.kinds) + ".";
    text += "\n\n| key | type | range | presence | meaning |\n|---|---|---|---|---|\n";
    for (const auto& p : table.parameters) {
      text += fmt::format("| `{}` | {} | {} | {} | {}{} |\n", p.name, p.type_text(), p.range_text(), presence_text(p),
                          p.meaning, p.kinds.empty() ? "" : " For " + kinds_text(p.kinds) + ".");
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
