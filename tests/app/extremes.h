#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "fem/loaded_mesh.h"

/// Scenes at their limits: what comes of one, and what has to hold.
namespace annulus::test {

/// `value` as it stands in the file, for `key` of table `table` ("stage", "ring", "mesh.sun_planet", "").
struct KeyValue {
  std::string table, key, value;
};
using Edits = std::vector<KeyValue>;

[[nodiscard]] std::string edited(const std::string& scene, const Edits& edits);
[[nodiscard]] std::string number(double value);

/// What came of solving one mesh of a scene.
struct Solved {
  std::optional<fem::LoadedMeshResult> result;
  std::optional<fem::LoadedMeshProblem> problem;
  std::string refusal;  ///< message; empty when solved
  bool early = false;   ///< refused before anything was computed
  std::string failure;  ///< neither solved nor refused

  /// N/m, mean over all positions at the middle load.
  [[nodiscard]] double stiffness() const;
  /// Relative, of that mean: parts that finer elements reduce, and all.
  [[nodiscard]] double numerical_error() const;
  [[nodiscard]] double whole_error() const;
};

struct SolveChoice {
  bool sun = false;  ///< the sun mesh instead of the ring mesh; pairs have one mesh only
  int phases = 8;    ///< instead of those planned, which serve the dynamics
  std::optional<int> degree{}, level{};
};

/// As the program: read, checked, planned, solved.
[[nodiscard]] Solved solve_scene(const std::string& text, const SolveChoice& choice = {});

/// What has to hold of every result whatever the scene, each broken rule in words: numbers finite, balances of force,
/// torque and energy, no tension, no penetration, stiffness and error above zero, pins that carry what the planet
/// presses. `light`: round-off of places in the teeth beside the deflection.
[[nodiscard]] std::vector<std::string> broken_rules(const fem::LoadedMeshProblem& problem,
                                                    const fem::LoadedMeshResult& result);

struct Tally {
  int tried = 0, survived = 0, refused_early = 0, refused_late = 0, failed = 0;
};

}  // namespace annulus::test
