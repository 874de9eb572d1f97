#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/key_rules.h"
#include "app/scene/scene.h"
#include "app/scene/scene_limits.h"

namespace annulus::app {

/// One key of a scene file. It is declared once, in the tables of all kinds (common_tables.cc, study_tables.cc) or of
/// one kind; parser, validation, `plan`, `explain` and the scene reference (docs/scene.md) come from that declaration.
struct Parameter {
  enum class Kind { integer, real, text, choice, reals, texts };
  enum class Presence { required, optional, defaulted };
  struct OldChoice {
    std::string old_name, name;
  };

  std::string table{};  ///< "stage", "mesh.sun_planet"; empty for the top level
  std::string name{};   ///< "module_mm"
  Kind kind = Kind::real;
  std::string unit{};  ///< for people, read off the suffix of the name: "mm"
  double si = 1;       ///< value in SI units = value in the file x si
  Presence presence = Presence::optional;
  Value default_value{};
  std::string note{};                       ///< reason of the default, or what absence means
  std::vector<std::string> kinds{};         ///< of gear systems that have this key; empty: those of its table
  std::vector<std::string> required_for{};  ///< kinds that cannot do without it, where others can
  double low = -rigid, high = rigid;
  bool low_included = true;
  bool may_be_infinite = false;
  std::size_t longest = longest_list;                   ///< values of a list
  std::string at_least_one{};                           ///< what a list consists of that may not be empty: "torque"
  bool distinct = false;                                ///< no value of a list stands twice
  bool often_assumed = false;                           ///< seldom known: [sensitivity] varies it if nothing is named
  std::vector<std::string> choices{};                   ///< permitted texts; empty: any
  std::vector<std::pair<std::string, double>> words{};  ///< texts for values of a number, in the unit of the file
  std::string meaning{};
  std::vector<std::string> old_names{};  ///< refused with the present name
  std::vector<OldChoice> old_choices{};  ///< the same for texts
  std::string without_table{};           ///< value that conditions see when its table is absent

  // Rules between keys (key_rules.h).
  std::vector<KeyRule> only_if{};  ///< refused where one of these does not hold
  std::vector<KeyRule> required_if{};
  std::vector<KeyRule> refused_if{};
  std::vector<std::string> together_with{};  ///< keys of the table that are given with this one or not at all
  std::vector<std::string> instead_of{};     ///< either this key or all of these, where the conditions hold
  std::vector<std::string> one_of{};         ///< exactly one of this key and these is given
  std::vector<std::string> some_of{};        ///< at least one of this key and these is given
  bool default_where_it_applies = false;     ///< the default holds only where `only_if` does

  /// Stores a checked value (in file units) into the scene; the index counts the tables of an array ([[ring]]). Throws
  /// InputError for what the value leads to, as a file without the right contents.
  std::function<void(Scene&, std::size_t, const Value&)> store{};

  [[nodiscard]] std::string key() const { return table.empty() ? name : table + "." + name; }
  [[nodiscard]] bool applies_to(const std::string& gear_system) const;
  [[nodiscard]] bool required(const std::string& gear_system) const;
  [[nodiscard]] std::string type_text() const;      ///< "a whole number", "a list of numbers"
  [[nodiscard]] bool in_range(double value) const;  ///< in the unit of the file
  [[nodiscard]] std::string range_text() const;     ///< "0 < value <= 100 mm"; empty when anything goes
};

struct Table {
  enum class Role { model, study };

  std::string path{};
  bool repeated = false;    ///< [[path]]: array of tables
  bool required = true;     ///< false: absent as a whole is fine, and then none of its keys applies
  bool on_request = false;  ///< its presence is itself the question: defaults apply only when it is there
  bool variants = false;    ///< of [[path]]: each is a variant that is computed and compared, by its name
  Role role = Role::model;
  std::string meaning{};
  std::vector<std::string> kinds{};  ///< of gear systems that have this table; empty: all
  std::vector<KeyRule> only_if{};    ///< refused where one of these does not hold
  std::vector<Parameter> parameters{};
  /// Makes room for the tables of an array ([[path]]).
  std::function<void(Scene&, std::size_t)> resize{};

  [[nodiscard]] bool applies_to(const std::string& kind) const;
  /// nullptr when the table has no such key.
  [[nodiscard]] const Parameter* find(const std::string& name) const;
  [[nodiscard]] std::string header() const { return repeated ? "[[" + path + "]]" : "[" + path + "]"; }
};

/// All tables in the order of the documentation; the first one, with an empty path, holds the top-level keys.
[[nodiscard]] const std::vector<Table>& schema();
/// The tables and keys of one kind of gear system. Throws InternalError when no kind of this name is registered.
[[nodiscard]] const std::vector<Table>& schema(const std::string& kind);
/// Tables of the format that this version cannot use yet, with what they will do.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& unavailable_tables();

/// Names of the registered kinds of gear systems, in their order.
[[nodiscard]] const std::vector<std::string>& stage_kinds();
/// "from, to and count"; empty without names.
[[nodiscard]] std::string listed(const std::vector<std::string>& names, const char* last = " and ");

/// Tables that ask for studies: no inputs of the model.
[[nodiscard]] bool is_study_table(const std::string& path);

/// nullptr when there is no such table.
[[nodiscard]] const Table* find_table(const std::string& path, const std::vector<Table>& tables = schema());
/// nullptr when there is no such key.
[[nodiscard]] const Parameter* find_parameter(const std::string& key, const std::vector<Table>& tables = schema());
[[nodiscard]] std::vector<std::string> all_keys();
/// The present key of an earlier one: "errors.sun_installation_um" -> "errors.sun_position_error_um"; empty when
/// there is none.
[[nodiscard]] std::string renamed_key(const std::string& old_key);

/// The scene reference as Markdown (docs/scene.md), and one key for `annulus explain KEY`.
[[nodiscard]] std::string scene_reference();
[[nodiscard]] std::string explain(const Parameter& parameter);
/// "required", "default 0.3 (steel)", "optional; absent: ...", "conditional" (on what: rule_texts).
[[nodiscard]] std::string presence_text(const Parameter& parameter);
/// "one of "linear", "logarithmic"".
[[nodiscard]] std::string choices_text(const Parameter& parameter);
/// What a key takes: "a number in mm, 0 < value <= 100 mm".
[[nodiscard]] std::string expected_text(const Parameter& parameter);
/// The rules between this key and others, one sentence each; empty without.
[[nodiscard]] std::vector<std::string> rule_texts(const Parameter& parameter);

}  // namespace annulus::app
