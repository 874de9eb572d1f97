#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_limits.h"

namespace annulus::app {

/// One key of a scene file. It is declared once, in scene_schema.cc; parser, validation, `plan`, `explain` and the
/// scene reference (docs/scene.md) come from that declaration.
struct Parameter {
  enum class Kind { integer, real, text, choice, reals, texts };
  enum class Presence { required, optional, defaulted };

  std::string table{};  ///< "stage", "mesh.sun_planet"; empty for the top level
  std::string name{};   ///< "module_mm"
  Kind kind = Kind::real;
  std::string unit{};  ///< for people, read off the suffix of the name: "mm"
  double si = 1;       ///< value in SI units = value in the file x si
  Presence presence = Presence::optional;
  Value default_value{};
  std::string note{};                     ///< reason of the default, or what absence means
  std::vector<StageKind> kinds{};         ///< of stages that have this key; empty: those of its table
  std::vector<StageKind> required_for{};  ///< kinds that cannot do without it, where others can
  double low = -rigid, high = rigid;
  bool low_included = true;
  bool may_be_infinite = false;
  std::size_t longest = longest_list;  ///< values of a list
  std::vector<std::string> choices{};
  std::string meaning{};
  /// Stores a checked value (in file units) into the scene; the index counts the tables of an array ([[ring]]).
  std::function<void(Scene&, std::size_t, const Value&)> store{};

  [[nodiscard]] std::string key() const { return table.empty() ? name : table + "." + name; }
  [[nodiscard]] bool applies_to(StageKind stage) const;
  [[nodiscard]] bool required(StageKind stage) const;
  [[nodiscard]] std::string type_text() const;      ///< "a whole number", "a list of numbers"
  [[nodiscard]] bool in_range(double value) const;  ///< in the unit of the file
  [[nodiscard]] std::string range_text() const;     ///< "0 < value <= 100 mm"; empty when anything goes
};

struct Table {
  std::string path{};
  bool repeated = false;    ///< [[path]]: array of tables
  bool required = true;     ///< false: absent as a whole is fine, and then none of its keys applies
  bool on_request = false;  ///< its presence is itself the question: defaults apply only when it is there
  std::string meaning{};
  std::vector<StageKind> kinds{};  ///< of stages that have this table; empty: all
  std::vector<Parameter> parameters{};
  /// Makes room for the tables of an array ([[path]]).
  std::function<void(Scene&, std::size_t)> resize{};

  [[nodiscard]] bool applies_to(StageKind kind) const;
  [[nodiscard]] std::string header() const { return repeated ? "[[" + path + "]]" : "[" + path + "]"; }
};

/// All tables in the order of the documentation; the first one, with an empty path, holds the top-level keys.
[[nodiscard]] const std::vector<Table>& schema();
/// Tables of the format that this version cannot use yet, with what they will do.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& unavailable_tables();

/// "planetary", as in the file.
[[nodiscard]] const char* kind_name(StageKind kind);
/// All of them, in the order of the enumeration.
[[nodiscard]] const std::vector<StageKind>& stage_kinds();
/// "planetary" or "planetary and two_k_v", for messages; empty when there is no restriction.
[[nodiscard]] std::string kinds_text(const std::vector<StageKind>& kinds);

/// Tables that ask for studies: no inputs of the model.
[[nodiscard]] bool is_study_table(const std::string& path);

/// A gear on a rigid hub, and the stiffness of a mesh (scene_schema.cc).
[[nodiscard]] Table hub_gear_table(const char* path, const char* meaning, const std::vector<StageKind>& kinds,
                                   HubGearInput& (*section)(Scene&, std::size_t));
[[nodiscard]] Table mesh_table(const char* path, const char* meaning, const std::vector<StageKind>& kinds,
                               MeshInput& (*section)(Scene&, std::size_t));

/// [pinion], [wheel], [mesh.pinion_wheel], [manufacturing_error], [transmission_error] (scene_schema_pair.cc).
void declare_pair(std::vector<Table>& tables);

/// [[sweep]], [monte_carlo], [[monte_carlo.input]], [sensitivity] (scene_schema_studies.cc).
void declare_studies(std::vector<Table>& tables);

/// [crank], [arc_gear], [input], [output] of a 2K-V stage (scene_schema_two_k_v.cc).
void declare_two_k_v(std::vector<Table>& tables);

/// nullptr when there is no such key.
[[nodiscard]] const Parameter* find_parameter(const std::string& key);
[[nodiscard]] std::vector<std::string> all_keys();

/// The scene reference as Markdown (docs/scene.md), and one key for `annulus explain KEY`.
[[nodiscard]] std::string scene_reference();
[[nodiscard]] std::string explain(const Parameter& parameter);
/// "required", "default 0.3 (steel)", "optional; absent: ...".
[[nodiscard]] std::string presence_text(const Parameter& parameter);

}  // namespace annulus::app
