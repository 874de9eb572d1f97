#pragma once

#include <algorithm>
#include <any>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <typeindex>
#include <vector>

#include "app/scene/inputs/common_input.h"
#include "app/scene/inputs/study_input.h"
#include "app/scene/scene_value.h"

namespace annulus::app {

/// What the user asks for, checked and in SI units. Every member is declared to the file format, with its key, unit,
/// default, bounds and meaning, in a table of the schema (scene_schema.h) and nowhere else. Inputs that not every kind
/// of gear system has are structs of the kinds (own).
struct Scene : StudyInput {
  std::filesystem::path file;
  std::string title;
  std::string project, author;  ///< for the report
  double accuracy = 0;
  Fidelity fidelity = Fidelity::automatic;
  std::optional<std::string> reference;
  StageInput stage;
  MaterialInput material;
  std::optional<DynamicsInput> dynamics;  ///< absent: no dynamics wanted
  std::vector<RotorInput> rotors;
  std::vector<std::string> further_files;  ///< that files of it name, relative to it

  /// The file as read, from which changed scenes are made (overrides.h). Empty in a changed scene, which has no studies
  /// of its own.
  std::string text;

  /// Inputs of a kind of gear system, or of several, that the members above do not have: structs that they define.
  template <class Inputs>
  [[nodiscard]] Inputs& own() {
    auto& known = own_[typeid(Inputs)];
    if (!known.has_value()) known.emplace<Inputs>();
    return std::any_cast<Inputs&>(known);
  }
  /// Their defaults where the scene has none of their tables.
  template <class Inputs>
  [[nodiscard]] const Inputs& own() const {
    static const Inputs none{};
    const auto known = own_.find(typeid(Inputs));
    return known != own_.end() ? std::any_cast<const Inputs&>(known->second) : none;
  }

  std::vector<Input> inputs;                   ///< every input with its origin, in the order of the schema
  std::map<std::string, std::string> assumed;  ///< key -> reason, as declared in [assumed]

  /// nullptr when the scene has no such input. `entry` counts the tables of an array.
  [[nodiscard]] const Input* find(const std::string& key, std::size_t entry = 0) const {
    const auto found =
        std::find_if(inputs.begin(), inputs.end(), [&](const Input& i) { return i.key == key && i.entry == entry; });
    return found == inputs.end() ? nullptr : &*found;
  }

 private:
  std::map<std::type_index, std::any> own_;
};

/// Reads and checks a scene file. Throws SceneError with *all* problems found.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file);
/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Scene parse_scene(const std::string& text, const std::filesystem::path& name);

}  // namespace annulus::app
