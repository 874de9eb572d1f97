#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/scene_value.h"

namespace annulus::app {

struct Table;

/// The keys of one scene as conditions see them. Keeps references to its arguments.
class KeyValues {
 public:
  KeyValues(const std::vector<Input>& inputs, const std::vector<Table>& tables);

  /// The key in the `entry`-th table of an array; nullptr when its table was not read.
  [[nodiscard]] const Input* find(const std::string& key, std::size_t entry) const;
  /// Written in the scene, with whatever value.
  [[nodiscard]] bool given(const std::string& key, std::size_t entry) const;
  /// Text of the value, of the default, or of what an absent table stands for; nothing when the value was refused or a
  /// required one is missing.
  [[nodiscard]] std::optional<std::string> text(const std::string& key, std::size_t entry) const;
  /// Whether a table was read. Optional tables whose keys all have defaults are always read.
  [[nodiscard]] bool has_table(const std::string& path) const;

 private:
  const std::vector<Input>& inputs_;
  const std::vector<Table>& tables_;
  std::map<std::pair<std::string, std::size_t>, std::size_t> places_;  ///< (key, entry) -> index of the input
};

/// What a rule asks of other keys (scene_declare.h):
///
///     is("structure", {"pinned", "bolted"})            a key of the same table has one of these values
///     is("mesh.sun_planet.stiffness", {"computed"})    a key of another table
///     given("pins"), given("[dynamics]")               a key is written, a table is there
///     a && b, a || b, !a
class Condition {
 public:
  friend Condition is(std::string key, std::vector<std::string> values);
  friend Condition given(std::string key_or_table);
  friend Condition operator&&(Condition a, Condition b);
  friend Condition operator||(Condition a, Condition b);
  friend Condition operator!(Condition a);

  /// Nothing when a value it depends on was refused. `entry` counts the tables of an array and holds for keys of
  /// `table`.
  [[nodiscard]] std::optional<bool> holds(const KeyValues& keys, const std::string& table, std::size_t entry) const;
  /// `structure = "pinned" or "bolted"`, `[dynamics]`; keys of `table` without its name.
  [[nodiscard]] std::string text(const std::string& table) const;
  /// The part of a condition that makes it hold: `structure = "pinned"`.
  [[nodiscard]] std::string cause(const KeyValues& keys, const std::string& table, std::size_t entry) const;

 private:
  enum class Kind { value, key, table, all, any, none };
  [[nodiscard]] std::string full_key(const std::string& table) const;
  [[nodiscard]] std::string shown_key(const std::string& table) const;
  [[nodiscard]] std::size_t entry_of(const std::string& table, std::size_t entry) const;

  Kind kind_ = Kind::value;
  std::string key_;
  std::vector<std::string> values_;
  std::vector<Condition> parts_;
};

[[nodiscard]] Condition is(std::string key, std::vector<std::string> values);
[[nodiscard]] Condition given(std::string key_or_table);
[[nodiscard]] Condition operator&&(Condition a, Condition b);
[[nodiscard]] Condition operator||(Condition a, Condition b);
[[nodiscard]] Condition operator!(Condition a);

/// A condition and its reason, as the schema declares them for a key or a table.
struct KeyRule {
  Condition when;
  std::string why{};                 ///< empty: the condition is enough
  std::vector<std::string> kinds{};  ///< kinds of gear systems with this rule; empty: all that have the key
};

}  // namespace annulus::app
