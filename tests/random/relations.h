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
  rounding,          ///< `relation_rounding`, and the error of a motion
  not_less,          ///< the second one is larger, or smaller by no more than the sum of the numerical errors
  identical,
};
/// Relative. The changes of the relations leave all numbers but for rounding; a result may amplify that a thousandfold
/// (contact on the edge of a load step), and steps of the time integration follow it.
inline constexpr double relation_rounding = 1e-8;

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
/// Relations that change keys know those of gear sets: of trains, whose gears are in files, only the accuracy and how
/// they are run change.
[[nodiscard]] std::optional<RunPair> pair_of(const Relation& relation, const RandomScene& scene);

/// One result of both runs.
struct ComparedResult {
  std::string key;
  double first = 0, second = 0;              ///< the first times the factor
  double allowed = 0;                        ///< difference
  [[nodiscard]] double effectivity() const;  ///< difference over allowed; 0 for equal values
  [[nodiscard]] bool agrees() const { return effectivity() <= 1; }
};

/// Results of both, with their errors where those count. Where results have to be equal, one that the other run does
/// not have is compared with what is not known, and differs.
[[nodiscard]] std::vector<ComparedResult> compared(const Relation& relation, const SceneRun& first,
                                                   const SceneRun& second);

}  // namespace annulus::random
