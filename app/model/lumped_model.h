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
  LumpedModel() = default;
  LumpedModel(const LumpedModel&) = delete;
  LumpedModel& operator=(const LumpedModel&) = delete;
  virtual ~LumpedModel() = default;

  /// Identity of everything the answers depend on.
  [[nodiscard]] virtual std::string id() const = 0;
  /// The results of the kind's model_figures. Throws what solving throws. Any number of threads at once.
  [[nodiscard]] virtual StudyPoint answer(Answer wanted) const = 0;
  /// The motion followed from several initial conditions; nothing for kinds that do not offer it.
  [[nodiscard]] virtual std::optional<StartSpread> starts(int /*count*/, int /*seed*/) const { return std::nullopt; }
};

/// A lumped model by the function that answers.
class AnsweringModel final : public LumpedModel {
 public:
  using Answers = std::function<StudyPoint(Answer wanted)>;
  using Starts = std::function<std::optional<StartSpread>(int count, int seed)>;
  AnsweringModel(std::string id, Answers answers, Starts starts = {})
      : id_(std::move(id)), answers_(std::move(answers)), starts_(std::move(starts)) {}

  [[nodiscard]] std::string id() const override { return id_; }
  [[nodiscard]] StudyPoint answer(Answer wanted) const override { return answers_(wanted); }
  [[nodiscard]] std::optional<StartSpread> starts(int count, int seed) const override {
    return starts_ ? starts_(count, seed) : std::nullopt;
  }

 private:
  std::string id_;
  Answers answers_;
  Starts starts_;
};

}  // namespace annulus::app
