#pragma once

#include <string>
#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::app {

/// A kind of gear system as the scene file knows it: the tables that it adds to the common ones, and its checks.
struct SceneKind {
  std::string name;  ///< value of stage.kind: "planetary"

  /// Tables of this kind in the order of the documentation. Keys of a table that all kinds have ([stage], [dynamics],
  /// [optimise]) are added to it.
  std::vector<Table> (*tables)() = nullptr;

  /// Completes a scene whose values are all of the right type and range and keep the rules of the schema; checks what
  /// the values of several keys have to fulfil together. Problems are appended, never thrown.
  void (*check)(Scene&, std::vector<Problem>&) = nullptr;

  /// Results that a search can optimise, by name.
  std::vector<std::string> (*results)() = nullptr;

  /// A complete scene of this kind, from which `annulus new` starts; none of kinds without gears, whose parts are
  /// files.
  const char* example = "";

  /// Whether it has gears of its own: module, face width, backlash, material. Else [stage] has its kind alone of the
  /// common keys, there is no [material], and [dynamics] has no keys of meshes.
  bool gears = true;
};

/// The registered kinds, in the order of the documentation. Defined in app/scene_kinds.cc, above the kinds: nothing in
/// app/scene names one.
[[nodiscard]] const std::vector<SceneKind>& scene_kinds();

/// Throws InternalError when no kind of this name is registered.
[[nodiscard]] const SceneKind& scene_kind(const std::string& name);

}  // namespace annulus::app
