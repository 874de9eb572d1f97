#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/scene_value.h"

namespace annulus::app {

struct Scene;
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
struct Condition {
  enum class Kind { value, key, table, all, any, none };
  Kind kind = Kind::value;
  std::string key{};  ///< or path of a table
  std::vector<std::string> values{};
  std::vector<Condition> parts{};

  /// Nothing when a value it depends on was refused. `entry` counts the tables of an array and holds for keys of
  /// `table`.
  [[nodiscard]] std::optional<bool> holds(const KeyValues& keys, const std::string& table, std::size_t entry) const;
  /// `structure = "pinned" or "bolted"`, `[dynamics]`; keys of `table` without its name.
  [[nodiscard]] std::string text(const std::string& table) const;
  /// The part of a condition that makes it hold: `structure = "pinned"`.
  [[nodiscard]] std::string cause(const KeyValues& keys, const std::string& table, std::size_t entry) const;
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

/// Checks the rules between keys that the schema declares (only_if, required_if, refused_if, together_with,
/// instead_of, one_of), and gives keys the defaults that hold under a condition. Problems are appended, never thrown; a
/// rule that depends on a refused value is left out.
void check_key_rules(const std::vector<Table>& tables, Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
