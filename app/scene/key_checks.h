#pragma once

#include <string>
#include <variant>
#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

/// Base of the checks of values that have to agree, for every kind of gear system (which keys go with which others is
/// declared in the tables). Problems are reported at the line of their key.
class KeyChecks {
 public:
  KeyChecks(Scene& scene, std::vector<Problem>& problems) : scene_(scene), problems_(problems) {}

 protected:
  /// Which table of an array, counted from 0, or which variant; by default the only table.
  using Entry = std::variant<std::size_t, std::string>;

  [[nodiscard]] Input* find(const std::string& key, const Entry& entry = std::size_t{0}) const;
  /// Written in the scene, with whatever value.
  [[nodiscard]] bool given(const std::string& key, const Entry& entry = std::size_t{0}) const;
  /// Written in the scene with a value of the right type and range, or left to its default.
  [[nodiscard]] bool usable(const std::string& key, const Entry& entry = std::size_t{0}) const;
  void problem(const std::string& key, const Entry& entry, const std::string& rule);
  void problem(const std::string& key, const std::string& rule) { problem(key, std::size_t{0}, rule); }
  /// Gives an input that follows from others, or from its default, a value in the unit of its key.
  void set(const std::string& key, const Value& value, Origin origin, const std::string& how,
           const Entry& entry = std::size_t{0});

  /// A name that others begin with ("motor_u", "first.sun") consists of letters, digits, _ and - alone.
  void simple_name(const std::string& key, const Entry& entry, const std::string& name);

  /// A prescribed stiffness stays positive; `harmonic`: the shapes with a cosine wave.
  void wave(const MeshInput& m, const std::string& path,
            const std::vector<StiffnessShape>& harmonic = {StiffnessShape::harmonic});

  Scene& scene_;
  std::vector<Problem>& problems_;
};

/// The values of [[sweep]], [[grid]], [monte_carlo], [sensitivity] and [optimise] in a scene that is otherwise right.
/// Whether each changed scene can be computed is left to check_studies (studies.h).
void check_study_keys(Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
