#include "app/scene/new_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <sstream>

#include "app/scene/scene_kind.h"
#include "core/json.h"

namespace annulus::app {

namespace {

/// As in JSON, whose escapes TOML shares; JSON leaves a delete character as it is, which TOML does not allow.
std::string quoted(const std::string& text) {
  return boost::replace_all_copy(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace), "\x7f", "\\u007f");
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
  std::string text = expected_text(p) + "; " + presence_text(p);
  for (const auto& rule : rule_texts(p)) text += "; " + rule;
  return text;
}

/// Whether one key of the group that this one declares has to be written, and none is.
bool group_is_missing(const Parameter& p, const NewValues& values) {
  const auto& others = p.one_of.empty() ? p.some_of : p.one_of;
  const auto is_given = [&](const std::string& name) { return values.count(p.table + "." + name) > 0; };
  return !others.empty() && !is_given(p.name) && std::none_of(others.begin(), others.end(), is_given);
}

std::string key_lines(const Parameter& p, const NewValues& values) {
  const std::string text = comment(p.meaning + " (" + facts(p) + ")");
  if (const auto given = values.find(p.key()); given != values.end()) {
    const auto& [value, remark] = given->second;
    return text + p.name + " = " + value + (remark.empty() ? "" : "    # " + remark) + "\n";
  }
  const bool required = p.presence == Parameter::Presence::required || group_is_missing(p, values);
  const bool defaulted = p.presence == Parameter::Presence::defaulted;
  return text + "# " + p.name + " =" +
         (required    ? "      <- to be filled in"
          : defaulted ? " " + toml_text(p.default_value)
                      : "") +
         "\n";
}

}  // namespace

std::string toml_text(const Value& value) {
  if (std::holds_alternative<std::monostate>(value)) return {};
  if (const auto* number = std::get_if<double>(&value)) return to_text(*number, 17);
  if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
  std::vector<std::string> items;
  if (const auto* numbers = std::get_if<std::vector<double>>(&value))
    for (const double x : *numbers) items.push_back(to_text(x, 17));
  else if (const auto* texts = std::get_if<std::vector<std::string>>(&value))
    for (const auto& text : *texts) items.push_back(quoted(text));
  else
    return to_text(value);
  return fmt::format("[{}]", fmt::join(items, ", "));
}

NewValues example_values(const std::string& kind) {
  NewValues values;
  if (!scene_kind(kind).gears) return {{"title", {quoted(kind)}}, {"stage.kind", {quoted(kind)}}};
  for (const auto& input : parse_scene(scene_kind(kind).example, "example.toml").inputs) {
    const auto* p = find_parameter(input.key);
    if (p == nullptr || input.origin != Origin::scene || input.entry > 0 || is_study_table(p->table)) continue;
    if (find_table(p->table, schema(kind))->on_request) continue;
    values[input.key] = {toml_text(input.value)};
  }
  values.erase("reference");
  values["title"] = {"\"" + kind + " stage\""};
  if (values.count("ring.name") > 0) values["ring.name"] = {"\"ring\""};
  return values;
}

std::string new_scene(const std::string& kind, const NewValues& values) {
  std::string text = comment("A scene for annulus: " + kind +
                             ". Every key has its meaning, unit, range and default. Keys behind '#' can be left out.");
  text += comment(
      "annulus check FILE validates it. annulus plan FILE shows the model and the predicted time. annulus run FILE "
      "computes it.");
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
