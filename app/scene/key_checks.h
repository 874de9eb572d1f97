#pragma once

#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

/// What checks of the rules between keys have in common, whatever the kind of stage. Problems are told at the place of
/// their key.
class KeyChecks {
 public:
  KeyChecks(Scene& scene, std::vector<Problem>& problems) : scene_(scene), problems_(problems) {}

 protected:
  [[nodiscard]] const Input* find(const std::string& key, const std::string& ring = "") const;
  /// Written in the scene, with whatever value.
  [[nodiscard]] bool given(const std::string& key, const std::string& ring = "") const;
  /// Written in the scene with a value of the right type and range, or left to its default.
  [[nodiscard]] bool usable(const std::string& key, const std::string& ring = "") const;
  void problem(const std::string& key, const std::string& ring, const std::string& rule);
  void required_if(bool condition, const std::vector<std::string>& keys, const std::string& ring, const char* why);
  void forbidden_unless(bool condition, const std::vector<std::string>& keys, const std::string& ring, const char* why);

  /// Gives an input that follows from others its value, in the unit of its key.
  void derive(const std::string& key, double value, const char* how);

  /// The keys of one [mesh.*].
  void mesh(const MeshInput& m, const std::string& path);
  /// Fixed steps need their number, the others choose it.
  void integrator();

  Scene& scene_;
  std::vector<Problem>& problems_;
};

}  // namespace annulus::app
