#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "app/scene/new_scene.h"
#include "core/errors.h"

namespace annulus::app {

/// A REXS file with its components by number.
class RexsFile {
 public:
  /// Throws InputError where it is none.
  explicit RexsFile(const std::filesystem::path& file);

  struct Component {
    int id = 0;
    std::string type, name;
    pugi::xml_node node;
  };
  struct Stage {
    int stage = 0, first = 0, second = 0;  ///< components
  };

  [[nodiscard]] InputError refusal(const std::string& why) const { return InputError(file_ + ": " + why); }
  [[nodiscard]] const Component& component(int id) const;
  [[nodiscard]] bool is(int id, const char* type) const { return component(id).type == type; }
  [[nodiscard]] std::vector<Stage> stages() const;
  /// Components that `type` relations put in `to` where `id` is in `from`.
  [[nodiscard]] std::vector<Component> related(const char* type, const char* from, int id,
                                               std::initializer_list<const char*> to) const;
  [[nodiscard]] std::vector<Component> of_type(const std::string& type) const;
  /// A number in `unit`; nothing when the component does not have it.
  [[nodiscard]] std::optional<double> number(const Component& c, const char* name, const std::string& unit) const;

 private:
  std::string file_;
  pugi::xml_document document_;
  std::map<int, Component> components_;
  std::vector<pugi::xml_node> relations_;
};

/// The values of a scene, filled from components.
class RexsValues {
 public:
  using Component = RexsFile::Component;
  /// The file is referred to.
  explicit RexsValues(const RexsFile& file) : file_(file) {}

  void put(const std::string& key, std::optional<double> value, const std::string& remark = "");
  void put_count(const std::string& key, double value);
  void put_text(const std::string& key, const std::string& text);
  /// Attributes of annulus itself: keys of `table`, or whole key paths where it is empty.
  void custom(const Component& c, const std::string& table);
  /// A gear's own keys.
  void gear(const Component& c, const std::string& table);
  /// What all gears of a stage have in common.
  void common(const Component& c, const std::optional<double>& centre_distance);
  /// Speed (r/min) and torque (N m) of a gear, stated at the gear or at its shaft: put under these keys.
  void operating_point(const Component& gear, const std::string& speed_key, const std::string& torque_key);

  NewValues values;

 private:
  /// Of a gear, into `table`: [material], or what the gear has otherwise.
  void material(const Component& c, const std::string& table);

  const RexsFile& file_;
};

}  // namespace annulus::app
