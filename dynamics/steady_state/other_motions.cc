#include "dynamics/steady_state/other_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "core/parallel.h"
#include "dynamics/steady_state/integration_cost.h"
#include "dynamics/steady_state/random_starts.h"
#include "dynamics/steady_state/reach_of_backlash.h"
#include "dynamics/steady_state/response_run.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::dynamics {

namespace {

constexpr int block = 12;  ///< periods: whole ones of 1, 2, 3, 4, 6 and 12
constexpr int force_samples = 64;
constexpr int fewest_starts = 4;

/// Twelve periods of the excitation.
struct Block {
  Eigen::MatrixXd high, low;  ///< N, largest and smallest force of every mesh, meshes x periods
  Eigen::VectorXd open;       ///< share of the time without contact, by mesh
};

/// Those in which the forces of a motion are stated: of the gears, else of the shafts.
std::vector<Eigen::Index> leading(const LumpedSystem& system, const std::vector<int>& meshes) {
  std::vector<Eigen::Index> gears;
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (system.is_gear_mesh(meshes[i])) gears.push_back(static_cast<Eigen::Index>(i));
  if (gears.empty())
    for (std::size_t i = 0; i < meshes.size(); ++i) gears.push_back(static_cast<Eigen::Index>(i));
  return gears;
}

/// Where a start leads to.
struct Followed {
  std::vector<Block> lately;  ///< the last one, or of an irregular motion the last third; empty: none was integrated
  int period = 0;             ///< 0: irregular
  bool decided = false;
  SystemState state;
  double evaluations = 0, per_block = 0;  ///< of the equations of motion
};

/// Largest and smallest force and loss of contact of every mesh, in rising order: planets may change places.
std::vector<std::array<double, 3>> features(const Block& b, double scale) {
  std::vector<std::array<double, 3>> list;
  for (Eigen::Index m = 0; m < b.high.rows(); ++m)
    list.push_back({b.high.row(m).maxCoeff() / scale, b.low.row(m).minCoeff() / scale, b.open[m]});
  std::sort(list.begin(), list.end());
  return list;
}

class Follower {
 public:
  static constexpr int least_blocks = 4;  ///< fewer decide nothing

  Follower(const LumpedSystem& system, const SteadyProblem& problem, const IntegratorOptions& integrator)
      : system_(system),
        problem_(problem),
        integrator_(integrator),
        meshes_(meshes_with_backlash(system)),
        leading_(leading(system, meshes_)) {}

  /// `most_evaluations`: of the equations of motion, before the neighbours of an irregular motion are followed.
  /// A start that the integrator cannot follow is not decided.
  [[nodiscard]] Followed follow(const SystemState& start, double most_evaluations) const {
    ResponseRun run(system_, problem_.mesh_frequency, force_samples, integrator_);
    run.start_from(start.q, start.v);
    Followed result;
    std::vector<Block> blocks;
    std::vector<double> changes;
    // Vibrations that have neither settled nor become irregular get as much time again.
    const auto affordable = [&] {
      return std::ssize(blocks) < least_blocks ||
             static_cast<double>(run.statistics().rhs_evaluations) < most_evaluations;
    };
    const auto decide = [&] {
      for (int round = 0; round < rounds && !result.decided && affordable(); ++round) {
        bool repeats = false;
        for (int i = 0; i < most_blocks && !repeats && affordable(); ++i) {
          blocks.push_back(advanced(run));
          const auto& now = blocks.back();
          if (blocks.size() > 1) changes.push_back(difference(now, blocks[blocks.size() - 2], 0));
          // A motion may pass close to an unstable one: one agreement is none.
          repeats = changes.size() > 2 && settled(changes, 0, scale(now)) && settled(changes, 1, scale(now));
        }
        result.state = run.state();
        result.state.time = 0;
        result.period = repeats ? period_of(blocks.back()) : unsettled_period(blocks[blocks.size() - 2], blocks.back());
        result.decided =
            result.period > 0 || (affordable() && keeps_changing(changes, scale(blocks.back())) && parts(result.state));
      }
    };
    bool failed = false;
    try {
      decide();
    } catch (const SolverError&) {
      failed = true;
      result = {};
    }
    result.evaluations = static_cast<double>(run.statistics().rhs_evaluations);
    result.per_block = result.evaluations / static_cast<double>(std::max<std::size_t>(blocks.size(), 1));
    if (failed) return result;
    // Irregular motions show their largest forces now and then.
    const auto shown = result.period > 0 ? 1 : static_cast<std::ptrdiff_t>(blocks.size() / 3);
    result.lately.assign(blocks.end() - shown, blocks.end());
    return result;
  }

  [[nodiscard]] double largest_force(const Followed& f) const {
    double largest = 0;
    for (const auto& b : f.lately)
      largest = std::max({largest, b.high(leading_, Eigen::all).maxCoeff(), -b.low(leading_, Eigen::all).minCoeff()});
    return largest;
  }
  [[nodiscard]] double contact_loss(const Followed& f) const {
    double largest = 0;
    for (const auto& b : f.lately) largest = std::max(largest, b.open(leading_).maxCoeff());
    return largest;
  }

  /// All irregular motions are one.
  [[nodiscard]] bool same(const Followed& a, const Followed& b) const {
    if (a.period == 0 || b.period == 0) return a.period == b.period;
    constexpr double share = 0.02;
    const auto &last = a.lately.back(), &other = b.lately.back();
    const double size = std::max(scale(last), scale(other));
    const auto x = features(last, size), y = features(other, size);
    for (std::size_t m = 0; m < x.size(); ++m)
      for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(x[m].at(i) - y[m].at(i)) > share) return false;
    return true;
  }

 private:
  static constexpr int most_blocks = 24, rounds = 2;
  static_assert(rounds * most_blocks * block == longest_start);
  static constexpr double still = 5e-3;  ///< of the force

  [[nodiscard]] double scale(const Block& b) const {
    return std::max(problem_.force_scale, std::max(b.high.maxCoeff(), -b.low.minCoeff()));
  }

  [[nodiscard]] Block advanced(ResponseRun& run) const {
    const auto meshes = static_cast<Eigen::Index>(meshes_.size());
    const Eigen::Index per_period = static_cast<Eigen::Index>(problem_.period_in_cycles) * force_samples;
    Block result{Eigen::MatrixXd(meshes, block), Eigen::MatrixXd(meshes, block), Eigen::VectorXd::Zero(meshes)};
    for (Eigen::Index period = 0; period < block; ++period) {
      ResponseWindow window;
      run.advance(problem_.period_in_cycles, &window);
      for (Eigen::Index i = 0; i < meshes; ++i) {
        const int m = meshes_[static_cast<std::size_t>(i)];
        result.high(i, period) = window.force.row(m).head(per_period).maxCoeff();
        result.low(i, period) = window.force.row(m).head(per_period).minCoeff();
        result.open[i] += window.open[m] / block;
      }
    }
    return result;
  }

  /// Largest difference of the extremes, period by period, the first ones `shift` periods later.
  static double difference(const Block& a, const Block& b, int shift) {
    double largest = 0;
    for (Eigen::Index i = 0; i < block; ++i) {
      const Eigen::Index j = (i + shift) % block;
      largest = std::max({largest, (a.high.col(j) - b.high.col(i)).cwiseAbs().maxCoeff(),
                          (a.low.col(j) - b.low.col(i)).cwiseAbs().maxCoeff()});
    }
    return largest;
  }

  /// Do the changes from block to block, up to the one `before` the last, continued geometrically, add up to nothing
  /// that matters?
  static bool settled(const std::vector<double>& changes, std::size_t before, double scale) {
    const std::size_t i = changes.size() - 1 - before;
    const double last = changes[i], ratio = last / changes[i - 1];
    constexpr double rounding = 1e-6;
    if (last <= rounding * scale) return true;
    return ratio < 1 && last / (1 - ratio) <= still * scale;
  }

  [[nodiscard]] int period_of(const Block& b) const {
    for (const int period : {1, 2, 3, 4, 6})
      if (difference(b, b, period) <= 2 * still * scale(b)) return period;
    return block;
  }

  /// The period of a motion whose last two blocks repeat, though its vibrations have not settled: one that does not
  /// divide twelve, or one whose small changes do not die out; 0: none.
  [[nodiscard]] int unsettled_period(const Block& before, const Block& last) const {
    Eigen::MatrixXd forces(2 * last.high.rows(), 2 * block);
    forces << before.high, last.high, before.low, last.low;
    for (int period = 1; period < block; ++period) {
      const Eigen::Index compared = 2 * block - period;
      if ((forces.rightCols(compared) - forces.leftCols(compared)).cwiseAbs().maxCoeff() <= still * scale(last))
        return period;
    }
    return 0;
  }

  /// Irregular motions change as much late as they did before; vibrations that die out slowly change less and less.
  static bool keeps_changing(const std::vector<double>& changes, double scale) {
    constexpr double less = 0.8, matters = 0.05;
    const auto third = static_cast<std::ptrdiff_t>(changes.size() / 3);
    const double middle = *std::max_element(changes.end() - 2 * third, changes.end() - third);
    const double late = *std::max_element(changes.end() - third, changes.end());
    return late >= less * middle && late >= matters * scale;
  }

  /// Do two states close to each other part? Vibrations that only die out slowly stay together.
  [[nodiscard]] bool parts(const SystemState& state) const {
    constexpr double apart = 1e-4, growth = 30;
    const double deflection = problem_.force_scale / problem_.stiffness;
    const auto after = [&](double moved) {
      ResponseRun run(system_, problem_.mesh_frequency, force_samples, integrator_);
      run.start_from(state.q.array() + moved, state.v);
      run.advance(2 * block * problem_.period_in_cycles, nullptr);
      return run.state();
    };
    const auto a = after(0), b = after(apart * deflection), c = after(-apart * deflection);
    const double distance = std::max((a.q - b.q).cwiseAbs().maxCoeff(), (a.q - c.q).cwiseAbs().maxCoeff());
    return distance > growth * apart * deflection;
  }

  const LumpedSystem& system_;
  const SteadyProblem& problem_;
  IntegratorOptions integrator_;
  std::vector<int> meshes_;
  std::vector<Eigen::Index> leading_;
};

}  // namespace

StableMotions stable_motions(const LumpedSystem& system, const SteadyProblem& problem, const SteadyOutcome& present,
                             const IntegratorOptions& integrator, const MotionSearch& search) {
  const double evaluations = longest_search_s / evaluation_seconds(system);
  const Follower follower(system, problem, integrator);
  const RandomStarts starts(system, problem, search.size);
  std::vector<Followed> followed(static_cast<std::size_t>(search.starts) + 1);
  const auto follow = [&](std::size_t i, double most_evaluations) {
    followed[i] = follower.follow(i == 0 ? starts.beside(present.begin) : starts.draw(i), most_evaluations);
  };
  // The first ones show how many others can be decided in the time.
  const auto shown = std::min<std::size_t>(followed.size(), 2);
  for_each_task(shown, search.threads,
                [&](std::size_t i) { follow(i, evaluations / static_cast<double>(followed.size())); });
  double left = evaluations, of_one = 0;
  for (std::size_t i = 0; i < shown; ++i) {
    left -= followed[i].evaluations;
    of_one = std::max(of_one, Follower::least_blocks * followed[i].per_block);
  }
  const auto others = followed.size() - shown;
  if (left < static_cast<double>(others) * of_one) {
    const int affordable = std::max(static_cast<int>(left / of_one), fewest_starts - 1);
    followed.resize(shown + std::min(others, static_cast<std::size_t>(affordable)));
  }
  for_each_task(followed.size() - shown, search.threads,
                [&](std::size_t i) { follow(shown + i, left / static_cast<double>(followed.size() - shown)); });
  StableMotions result;
  result.found.starts = static_cast<int>(followed.size()) - 1;
  std::vector<std::size_t> examples;
  for (std::size_t i = 0; i < followed.size(); ++i) {
    const auto& f = followed[i];
    if (!f.decided) {
      // A steady motion is one, however slowly the rest of its vibrations dies out.
      const bool known = i == 0 && present.steady && !f.lately.empty();
      if (i > 0) ++result.found.undecided;
      if (!known) continue;
      followed[i].period = 1;
    }
    std::size_t number = 0;
    while (number < examples.size() && !follower.same(followed[examples[number]], f)) ++number;
    auto& motions = result.found.list;
    if (number == examples.size()) {
      examples.push_back(i);
      motions.push_back({f.period, follower.largest_force(f), follower.contact_loss(f), 0, i == 0});
    }
    auto& motion = motions[number];
    if (i > 0) ++motion.starts;
    if (f.period == 0) {
      motion.largest_force = std::max(motion.largest_force, follower.largest_force(f));
      motion.contact_loss = std::max(motion.contact_loss, follower.contact_loss(f));
    }
  }
  std::vector<std::size_t> order(examples.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return result.found.list[a].largest_force > result.found.list[b].largest_force;
  });
  std::vector<FoundMotion> sorted;
  for (const std::size_t i : order) {
    sorted.push_back(result.found.list[i]);
    result.states.push_back(followed[examples[i]].state);
  }
  result.found.list = std::move(sorted);
  return result;
}

int affordable_starts(const LumpedSystem& system, const SteadyProblem& problem, const IntegratorOptions& integrator,
                      int wanted, StiffnessCourse course) {
  const double of_start = integration_seconds(system, problem.mesh_frequency,
                                              periods_of_a_start * problem.period_in_cycles, integrator, course);
  const int starts = static_cast<int>(std::min<double>(wanted, usual_search_s / of_start));
  return starts < std::min(fewest_starts, wanted) ? 0 : starts;
}

}  // namespace annulus::dynamics
