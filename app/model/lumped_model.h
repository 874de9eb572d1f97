#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/figure.h"
#include "dynamics/figures/motion.h"
#include "dynamics/spatial/space_motion.h"
#include "dynamics/steady_state/branches.h"

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
  /// All results of the motion followed in time from a state at time 0 (null: from equilibrium), and its end.
  struct FollowedPoint {
    StudyPoint point{};
    dynamics::SystemState end{};
  };
  using Follow = std::function<FollowedPoint(const dynamics::SystemState* start)>;
  /// The system itself.
  using Lumped = std::function<dynamics::LumpedCase()>;
  /// What bearings and meshes do in a time series of the system; empty where bodies stay in their plane.
  using Space = std::function<dynamics::SpaceMotion(const dynamics::TimeSeries& series)>;
  /// What not every kind offers; `follow` and `lumped` as GearSystem::offers says.
  struct Abilities {
    Starts starts{};
    Follow follow{};
    Lumped lumped{};
    Space space{};
  };

  /// `id`: identity of everything the answers depend on.
  LumpedModel(std::string id, Answers answers) : LumpedModel(std::move(id), std::move(answers), Abilities()) {}
  LumpedModel(std::string id, Answers answers, Abilities abilities)
      : id_(std::move(id)), answers_(std::move(answers)), abilities_(std::move(abilities)) {}

  [[nodiscard]] const std::string& id() const { return id_; }
  [[nodiscard]] StudyPoint answer(Answer wanted) const { return answers_(wanted); }
  [[nodiscard]] std::optional<StartSpread> starts(int count, int seed) const {
    if (!abilities_.starts) return std::nullopt;
    return abilities_.starts(count, seed);
  }
  [[nodiscard]] FollowedPoint followed(const dynamics::SystemState* start) const { return abilities_.follow(start); }
  /// Throws InputError where the kind does not offer it.
  [[nodiscard]] dynamics::LumpedCase lumped() const {
    if (!abilities_.lumped) throw InputError("the lumped model of this kind of stage is not a system by itself");
    return abilities_.lumped();
  }
  [[nodiscard]] dynamics::SpaceMotion in_space(const dynamics::TimeSeries& series) const {
    return abilities_.space ? abilities_.space(series) : dynamics::SpaceMotion{};
  }

 private:
  std::string id_;
  Answers answers_;
  Abilities abilities_;
};

/// One way to make and solve a lumped model, as the cost study measures it.
struct ModelWay {
  std::string fidelity{};      ///< "harmonic balance", "time integration", "shooting", "coupling"; empty: as in a run
  std::string settings{};      ///< "64 samples per mesh cycle", "sun held in place"
  std::string id{};            ///< identity of everything the results depend on
  bool finest = false;         ///< the others are compared with it
  bool changes_model = false;  ///< its error is not one of numbers
  /// The results, with the errors that the program states. Throws when there is no periodic motion.
  std::function<FigureSet()> figures{};
};

/// All ways to a lumped model on some tables.
struct ModelWays {
  ModelWay as_run{};  ///< with the errors of the tables; without `figures`: its LumpedModel with propagated errors
  std::vector<ModelWay> others{};
};

}  // namespace annulus::app
