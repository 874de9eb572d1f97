#include "app/scene/toml/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "app/scene/scene_limits.h"
#include "app/scene/scene_value.h"

namespace annulus::app {

namespace {

/// "must be one of ..." for a text that is none of the permitted ones; empty for those.
std::string choice_rule(const Parameter& p, const std::string& text) {
  if (p.choices.empty() || std::find(p.choices.begin(), p.choices.end(), text) != p.choices.end()) return "";
  for (const auto& old : p.old_choices)
    if (text == old.old_name) return fmt::format("is now \"{}\"", old.name);
  const std::string near = nearest(text, p.choices);
  return "must be " + choices_text(p) + (near.empty() ? "" : "; did you mean \"" + near + "\"?");
}

double as_double(const toml::node& node) {
  return node.is_integer() ? static_cast<double>(**node.as_integer()) : **node.as_floating_point();
}

}  // namespace

std::string node_text(const toml::node& node) {
  if (node.is_table() || node.is_array_of_tables()) return "{...}";
  if (const auto* text = node.as_string()) return '"' + shown(**text) + '"';
  if (const auto* number = node.as_floating_point()) {
    // A whole-valued float must look like one, or "5 must be a whole number" would puzzle.
    if (std::isnan(**number)) return "nan";
    const std::string text = to_text(**number, 15);
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
  }
  std::ostringstream out;
  node.visit([&](const auto& n) { out << n; });
  return shown(out.str());
}

std::string text_rule(const std::string& text) {
  if (has_controls(text)) return "must be one line without control characters";
  if (text.size() > longest_text)
    return fmt::format("has {} bytes, at most {} are possible", text.size(), longest_text);
  return "";
}

std::string read_value(const Parameter& p, const toml::node& node, Value& value) {
  using Kind = Parameter::Kind;
  const bool texts = p.kind == Kind::text || p.kind == Kind::texts || p.kind == Kind::choice;
  const auto right_type = [&](const toml::node& n) {
    return texts ? n.is_string() : n.is_integer() || (p.kind != Kind::integer && n.is_floating_point());
  };
  const auto rule = [&](const toml::node& n) -> std::string {
    if (!texts) return p.in_range(as_double(n)) ? "" : "must be in range: " + p.range_text();
    const std::string& text = **n.as_string();
    const auto wrong = p.kind == Kind::choice ? "" : text_rule(text);
    return wrong.empty() ? choice_rule(p, text) : wrong;
  };
  if (const auto* text = node.as_string(); text && !p.words.empty()) {
    const auto word = std::find_if(p.words.begin(), p.words.end(), [&](const auto& w) { return w.first == **text; });
    if (word == p.words.end()) return "must be " + expected_text(p);
    value = word->second;
    return "";
  }
  if (p.kind != Kind::reals && p.kind != Kind::texts) {
    if (!right_type(node)) return "must be " + expected_text(p);
    if (p.kind == Kind::integer)
      value = static_cast<long>(**node.as_integer());
    else if (texts)
      value = **node.as_string();
    else
      value = as_double(node);
    return rule(node);
  }
  const auto* array = node.as_array();
  if (!array || !std::all_of(array->begin(), array->end(), right_type)) return "must be " + expected_text(p);
  if (array->size() > p.longest) return fmt::format("has {} values, at most {} are possible", array->size(), p.longest);
  std::vector<double> numbers;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const auto& item = *array->get(i);
    if (const auto wrong = rule(item); !wrong.empty()) return fmt::format("value {} {}", i + 1, wrong);
    if (texts)
      words.push_back(**item.as_string());
    else
      numbers.push_back(as_double(item));
  }
  if (!p.at_least_one.empty() && array->empty()) return "needs at least one " + p.at_least_one;
  if (p.distinct && std::set<double>(numbers.begin(), numbers.end()).size() != numbers.size())
    return "contains the same value twice; leave one out";
  if (texts)
    value = std::move(words);
  else
    value = std::move(numbers);
  return "";
}

toml::table parse_toml(const std::string& text, const std::string& file) {
  check_scene_text(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    throw SceneError(file, {{static_cast<int>(at.line), static_cast<int>(at.column),
                             "not valid TOML: " + std::string(error.description())}});
  }
}

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw InputError(file.string() + ": cannot be read; is the path right?");
  std::string text(largest_scene + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace annulus::app
