#include "app/scene/condition.h"

#include <algorithm>

#include "app/scene/scene_schema.h"

namespace annulus::app {

namespace {

std::string table_of(const std::string& key) {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

std::string quoted_list(const std::vector<std::string>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += (i == 0 ? "\"" : i + 1 == values.size() ? " or \"" : ", \"") + values[i] + "\"";
  return text;
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
  for (const auto& table : tables_) {
    if (table.path != table_of(key)) continue;
    for (const auto& p : table.parameters)
      if (p.key() == key) return p.without_table;
  }
  return "";
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

std::string Condition::full_key(const std::string& table) const {
  const bool relative = key_.find('.') == std::string::npos && !table.empty();
  return relative ? table + "." + key_ : key_;
}

std::string Condition::shown_key(const std::string& table) const {
  return table_of(key_) == table && !table.empty() ? key_.substr(table.size() + 1) : key_;
}

std::size_t Condition::entry_of(const std::string& table, std::size_t entry) const {
  return table_of(full_key(table)) == table ? entry : 0;
}

std::optional<bool> Condition::holds(const KeyValues& keys, const std::string& table, std::size_t entry) const {
  switch (kind_) {
    case Kind::value: {
      const auto value = keys.text(full_key(table), entry_of(table, entry));
      if (!value) return std::nullopt;
      return std::find(values_.begin(), values_.end(), *value) != values_.end();
    }
    case Kind::key:
      return keys.given(full_key(table), entry_of(table, entry));
    case Kind::table:
      return keys.has_table(key_);
    case Kind::none: {
      const auto part = parts_.front().holds(keys, table, entry);
      if (!part) return std::nullopt;
      return !*part;
    }
    case Kind::all:
    case Kind::any:
      break;
  }
  const bool decisive = kind_ == Kind::any;  // one part with this value decides
  std::optional<bool> result = !decisive;
  for (const auto& part : parts_) {
    const auto value = part.holds(keys, table, entry);
    if (value == decisive) return decisive;
    if (!value) result = std::nullopt;
  }
  return result;
}

std::string Condition::text(const std::string& table) const {
  switch (kind_) {
    case Kind::value:
      return shown_key(table) + " = " + quoted_list(values_);
    case Kind::key:
      return shown_key(table);
    case Kind::table:
      return "[" + key_ + "]";
    case Kind::none: {
      const auto& part = parts_.front();
      if (part.kind_ == Kind::value) return part.shown_key(table) + " other than " + quoted_list(part.values_);
      return "no " + part.text(table);
    }
    case Kind::all:
    case Kind::any:
      break;
  }
  std::string text;
  for (const auto& part : parts_)
    text += (text.empty() ? "" : kind_ == Kind::all ? " and " : " or ") + part.text(table);
  return text;
}

std::string Condition::cause(const KeyValues& keys, const std::string& table, std::size_t entry) const {
  if (kind_ == Kind::value) {
    const std::string key = full_key(table);
    const auto value = keys.text(key, entry_of(table, entry));
    const bool implied = keys.find(key, entry_of(table, entry)) == nullptr;
    return shown_key(table) + " = \"" + value.value_or("") + "\"" +
           (implied ? " (the scene has no [" + table_of(key) + "])" : "");
  }
  if (kind_ == Kind::any) {
    for (const auto& part : parts_)
      if (part.holds(keys, table, entry) == true) return part.cause(keys, table, entry);
  }
  if (kind_ != Kind::all) return text(table);
  std::string all;
  for (const auto& part : parts_) all += (all.empty() ? "" : " and ") + part.cause(keys, table, entry);
  return all;
}

Condition is(std::string key, std::vector<std::string> values) {
  Condition c;
  c.kind_ = Condition::Kind::value;
  c.key_ = std::move(key);
  c.values_ = std::move(values);
  return c;
}

Condition given(std::string key_or_table) {
  Condition c;
  const bool table = key_or_table.starts_with('[');
  c.kind_ = table ? Condition::Kind::table : Condition::Kind::key;
  c.key_ = table ? key_or_table.substr(1, key_or_table.size() - 2) : std::move(key_or_table);
  return c;
}

Condition operator&&(Condition a, Condition b) {
  Condition c;
  c.kind_ = Condition::Kind::all;
  c.parts_ = {std::move(a), std::move(b)};
  return c;
}

Condition operator||(Condition a, Condition b) {
  Condition c;
  c.kind_ = Condition::Kind::any;
  c.parts_ = {std::move(a), std::move(b)};
  return c;
}

Condition operator!(Condition a) {
  Condition c;
  c.kind_ = Condition::Kind::none;
  c.parts_ = {std::move(a)};
  return c;
}

}  // namespace annulus::app
