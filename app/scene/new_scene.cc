#include "app/scene/new_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "app/scene/scene_kind.h"

namespace annulus::app {

namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < ' ' || c == '\x7f')
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      result += c;
  }
  return result + "\"";
}

std::string number(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return to_text(value, 17);
}

/// Lines of a comment, broken between words.
std::string comment(const std::string& text) {
  constexpr std::size_t width = 110;
  std::istringstream words(text);
  std::string lines, line = "#";
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > width) {
      lines += line + "\n";
      line = "#";
    }
    line += " " + word;
  }
  return lines + line + "\n";
}

/// What stands behind the meaning: "number in mm, 0 < value <= 100 mm; default 3 (why)".
std::string facts(const Parameter& p) {
  std::string text = p.type_text();
  if (!p.unit.empty()) text += " in " + p.unit;
  if (const auto range = p.range_text(); !range.empty()) text += ", " + range;
  text += "; " + presence_text(p);
  for (const auto& rule : rule_texts(p)) text += "; " + rule;
  return text;
}

std::string key_lines(const Parameter& p, const NewValues& values) {
  const bool required = p.presence == Parameter::Presence::required;
  const auto given = values.find(p.key());
  std::string text = comment(p.meaning + " (" + facts(p) + ")");
  if (given != values.end()) {
    text += p.name + " = " + given->second.text;
    return text + (given->second.remark.empty() ? "\n" : "    # " + given->second.remark + "\n");
  }
  if (required) return text + "# " + p.name + " =      <- to be filled in\n";
  return text + "# " + p.name + " =" +
         (p.presence == Parameter::Presence::defaulted ? " " + toml_text(p.default_value) : "") + "\n";
}

}  // namespace

std::string toml_text(const Value& value) {
  return std::visit(
      [](const auto& v) -> std::string {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::monostate>) {
          return {};
        } else if constexpr (std::is_same_v<T, long>) {
          return std::to_string(v);
        } else if constexpr (std::is_same_v<T, double>) {
          return number(v);
        } else if constexpr (std::is_same_v<T, std::string>) {
          return quoted(v);
        } else {
          std::string list;
          for (const auto& item : v) {
            if (!list.empty()) list += ", ";
            if constexpr (std::is_same_v<T, std::vector<double>>)
              list += number(item);
            else
              list += quoted(item);
          }
          return "[" + list + "]";
        }
      },
      value);
}

NewValues example_values(const std::string& kind) {
  NewValues values;
  for (const auto& input : parse_scene(scene_kind(kind).example, "example.toml").inputs) {
    const auto* p = find_parameter(input.key);
    if (p == nullptr || input.origin != Origin::scene || input.entry > 0 || is_study_table(p->table)) continue;
    const auto& tables = schema(kind);
    const auto table = std::find_if(tables.begin(), tables.end(), [&](const auto& t) { return t.path == p->table; });
    if (table->on_request && table->path != "dynamics") continue;
    values[input.key] = {toml_text(input.value)};
  }
  values.erase("reference");
  values["title"] = {"\"" + kind + " stage\""};
  if (values.count("ring.name") > 0) values["ring.name"] = {"\"ring\""};
  return values;
}

std::string new_scene(const std::string& kind, const NewValues& values) {
  std::string text =
      comment("A scene for annulus: " + kind +
              ". Every key stands with its meaning, unit, range and default; those behind '#' can be left out.");
  text += comment(
      "annulus check FILE validates it, annulus plan FILE shows what will be modelled and how long it takes, annulus "
      "run FILE computes it.");
  for (const auto& table : schema(kind)) {
    const auto& keys = table.parameters;
    const bool used =
        table.path.empty() || std::any_of(keys.begin(), keys.end(), [&](const auto& p) {
          return values.count(p.key()) > 0 || (table.required && p.presence == Parameter::Presence::required);
        });
    text += "\n";
    if (!table.path.empty()) {
      std::string meaning = table.meaning;
      if (table.repeated) meaning += " One or more.";
      text += comment(meaning) + (used ? "" : "# ") + table.header() + "\n";
    }
    for (const auto& p : keys) text += key_lines(p, values);
  }
  return text;
}

}  // namespace annulus::app
