#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/random/random_scene.h"
#include "tests/random/scene_run.h"

namespace annulus::random {

/// Two runs whose results have to agree.
struct RunPair {
  std::string first, second;  ///< scenes
  std::string first_arguments = "", second_arguments = "";
  bool second_reuses = false;  ///< the second runs in the folder of the first
};

/// How far the results of a pair may differ.
enum class Agreement {
  errors,            ///< the sum of their errors
  numerical_errors,  ///< that without the parts of the model
  rounding,          ///< what rounding makes of steps that depend on it, `relation_rounding`, and the error of a motion
  identical,
};
inline constexpr double relation_rounding = 2e-5;

/// A relation that holds between the results of two scenes, or of two runs of one.
struct Relation {
  std::string name;
  Agreement agreement = Agreement::rounding;
  /// Nothing where it has no meaning.
  std::function<std::optional<RunPair>(const RandomScene&)> pair;
  /// Second over first result of this key; nothing where the relation says nothing about it.
  std::function<std::optional<double>(const std::string& key)> factor;
};

[[nodiscard]] const std::vector<Relation>& relations();

/// One result of both runs.
struct ComparedResult {
  std::string key;
  double first = 0, second = 0;              ///< the first times the factor
  double allowed = 0;                        ///< difference
  [[nodiscard]] double effectivity() const;  ///< difference over allowed; 0 for equal values
  [[nodiscard]] bool agrees() const { return effectivity() <= 1; }
};

/// Results that both state, with their errors where those count.
[[nodiscard]] std::vector<ComparedResult> compared(const Relation& relation, const SceneRun& first,
                                                   const SceneRun& second);

}  // namespace annulus::random
