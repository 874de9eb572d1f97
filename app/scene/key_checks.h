#pragma once

#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

/// Base of the checks of values that have to agree, for every kind of gear system (which keys go with which others is
/// declared in the tables). Problems are reported at the line of their key.
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
  /// Gives an input that follows from others its value, in the unit of its key.
  void derive(const std::string& key, double value, const char* how);

  /// A prescribed stiffness stays positive; `harmonic`: the shapes with a cosine wave.
  void wave(const MeshInput& m, const std::string& path,
            const std::vector<StiffnessShape>& harmonic = {StiffnessShape::harmonic});

  Scene& scene_;
  std::vector<Problem>& problems_;
};

}  // namespace annulus::app
