#include "app/scene/toml/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/scene/scene_limits.h"
#include "app/scene/scene_value.h"

namespace annulus::app {

namespace {

std::string too_long(const Parameter& p, std::size_t size) {
  return fmt::format("has {} values, at most {} are possible", size, p.longest);
}

/// "must be one of ..." for a text that is none of the permitted ones; empty for those.
std::string choice_rule(const Parameter& p, const std::string& text) {
  if (p.choices.empty() || std::find(p.choices.begin(), p.choices.end(), text) != p.choices.end()) return "";
  for (const auto& old : p.old_choices)
    if (text == old.old_name) return fmt::format("is now \"{}\"", old.name);
  const std::string near = nearest(text, p.choices);
  return "must be " + choices_text(p) + (near.empty() ? "" : "; did you mean \"" + near + "\"?");
}

}  // namespace

Place place_of(const toml::source_region& source) {
  return {static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

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

std::string expected_text(const Parameter& p) {
  const auto range = p.range_text();
  return p.type_text() + (range.empty() ? "" : ", " + range);
}

std::string text_rule(const std::string& text) {
  if (has_controls(text)) return "must be one line without control characters";
  if (text.size() > longest_text)
    return fmt::format("has {} bytes, at most {} are possible", text.size(), longest_text);
  return "";
}

std::string read_value(const Parameter& p, const toml::node& node, Value& value) {
  switch (p.kind) {
    case Parameter::Kind::integer:
      if (!node.is_integer()) return "must be " + expected_text(p);
      value = static_cast<long>(**node.as_integer());
      if (!p.in_range(static_cast<double>(std::get<long>(value)))) return "must be in range: " + p.range_text();
      break;
    case Parameter::Kind::real:
      if (!node.is_number()) return "must be " + expected_text(p);
      value = *node.value<double>();
      if (!p.in_range(std::get<double>(value))) return "must be in range: " + p.range_text();
      break;
    case Parameter::Kind::reals: {
      const auto* array = node.as_array();
      if (array && array->size() > p.longest) return too_long(p, array->size());
      std::vector<double> list;
      for (std::size_t i = 0; array && i < array->size(); ++i) {
        const auto* item = array->get(i);
        if (!item->is_number()) return "must be " + expected_text(p);
        list.push_back(*item->value<double>());
        if (!p.in_range(list.back())) return fmt::format("value {} must be in range: {}", i + 1, p.range_text());
      }
      if (!array) return "must be " + expected_text(p);
      value = std::move(list);
      break;
    }
    case Parameter::Kind::texts: {
      const auto* array = node.as_array();
      if (array && array->size() > p.longest) return too_long(p, array->size());
      std::vector<std::string> list;
      for (std::size_t i = 0; array && i < array->size(); ++i) {
        const auto* item = array->get(i)->as_string();
        if (!item) return "must be " + expected_text(p);
        if (auto rule = text_rule(**item); !rule.empty()) return rule;
        list.push_back(**item);
      }
      if (!array) return "must be " + expected_text(p);
      for (std::size_t i = 0; i < list.size(); ++i)
        if (auto rule = choice_rule(p, list[i]); !rule.empty()) return fmt::format("value {} {}", i + 1, rule);
      value = std::move(list);
      break;
    }
    case Parameter::Kind::text:
      if (!node.is_string()) return "must be " + expected_text(p);
      if (auto rule = text_rule(**node.as_string()); !rule.empty()) return rule;
      value = **node.as_string();
      break;
    case Parameter::Kind::choice: {
      const auto text = node.value<std::string>();
      if (!text) return "must be " + expected_text(p);
      if (auto rule = choice_rule(p, *text); !rule.empty()) return rule;
      value = *text;
      break;
    }
  }
  return "";
}

}  // namespace annulus::app
