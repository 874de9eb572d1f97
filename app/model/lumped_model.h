#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/figure.h"
#include "dynamics/figures/poincare_point.h"

namespace annulus::app {

/// The results of one response, or why there are none.
struct StudyPoint {
  FigureRow figures{};
  std::vector<dynamics::PoincarePoint> poincare{};  ///< where the motion was asked for
  std::string failure{};                            ///< empty: none
  /// NaN for a point that failed.
  [[nodiscard]] double value(const std::string& key) const { return figures.value(key); }
};

/// Steady motions found from several initial conditions.
struct StartSpread {
  int starts = 0, motions = 0;  ///< motions: distinct ones
  FigureRow low{}, high{};      ///< results of effort `forces` over the starts
  int not_steady = 0;
};

/// What is asked of a lumped model: all its results, or those that need no motion (FigureEffort), the others NaN.
enum class Answer { all, without_motion };

/// A lumped model of a gear system on the stiffness tables of its meshes.
class LumpedModel {
 public:
  /// The results of the kind's model_figures. Throws what solving throws. Any number of threads at once.
  using Answers = std::function<StudyPoint(Answer wanted)>;
  /// The motion followed from several initial conditions.
  using Starts = std::function<StartSpread(int count, int seed)>;

  /// `id`: identity of everything the answers depend on. `starts`: empty for kinds that do not offer it.
  LumpedModel(std::string id, Answers answers, Starts starts = {})
      : id_(std::move(id)), answers_(std::move(answers)), starts_(std::move(starts)) {}

  [[nodiscard]] const std::string& id() const { return id_; }
  [[nodiscard]] StudyPoint answer(Answer wanted) const { return answers_(wanted); }
  [[nodiscard]] std::optional<StartSpread> starts(int count, int seed) const {
    if (!starts_) return std::nullopt;
    return starts_(count, seed);
  }

 private:
  std::string id_;
  Answers answers_;
  Starts starts_;
};

}  // namespace annulus::app
