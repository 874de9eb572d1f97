#include "dynamics/steady_state/other_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/parallel.h"
#include "dynamics/modes/modes.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/statistics/sampling.h"
#include "dynamics/steady_state/frequency_response.h"
#include "dynamics/steady_state/response_run.h"
#include "dynamics/steady_state/sampled_meshes.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::dynamics {

namespace {

/// Half the backlash of a mesh, of its face where it is spread over one; absent: flanks pull as well.
std::optional<double> half_backlash(const LumpedSystem& system, int mesh) {
  for (const auto& face : system.faces())
    if (face.approach == mesh) return face.half_backlash;
  return system.meshes()[static_cast<std::size_t>(mesh)].half_backlash;
}

/// The meshes that can lose contact.
std::vector<int> meshes_with_backlash(const LumpedSystem& system) {
  std::vector<int> list;
  for (int m = 0; m < static_cast<int>(system.meshes().size()); ++m)
    if (system.is_whole_mesh(m) && half_backlash(system, m).value_or(0) > 0) list.push_back(m);
  return list;
}

constexpr int block = 12;  ///< periods: whole ones of 1, 2, 3, 4, 6 and 12
constexpr int force_samples = 32;

/// Twelve periods of the excitation.
struct Block {
  Eigen::MatrixXd high, low;  ///< N, largest and smallest force of every mesh, meshes x periods
  Eigen::VectorXd open;       ///< share of the time without contact, by mesh
};

/// Where a start leads to.
struct Followed {
  Block last;
  int period = 0;  ///< 0: irregular
  bool decided = false;
  SystemState state;
  [[nodiscard]] double largest_force() const { return std::max(last.high.maxCoeff(), -last.low.minCoeff()); }
};

/// Forces of a motion by mesh, in rising order: planets may change places.
Eigen::MatrixXd features(const Block& b, double scale) {
  Eigen::MatrixXd list(b.high.rows(), 3);
  list << b.high.rowwise().maxCoeff() / scale, b.low.rowwise().minCoeff() / scale, b.open;
  for (auto column : list.colwise()) std::sort(column.begin(), column.end());
  return list;
}

class Follower {
 public:
  Follower(const LumpedSystem& system, const SteadyProblem& problem, const IntegratorOptions& integrator)
      : system_(system), problem_(problem), integrator_(integrator), meshes_(meshes_with_backlash(system)) {}

  [[nodiscard]] Followed follow(const SystemState& start) const {
    ResponseRun run(system_, problem_.mesh_frequency, force_samples, integrator_);
    run.start_from(start.q, start.v);
    Followed result;
    std::vector<double> changes;
    for (int i = 0; i < most_blocks; ++i) {
      const Block now = advanced(run);
      if (i > 0) {
        changes.push_back(difference(now, result.last, 0));
        if (settled(changes, scale(now))) {
          result.decided = true;
          result.period = period_of(now);
          result.last = now;
          break;
        }
      }
      result.last = now;
    }
    if (!result.decided) result.decided = keeps_changing(changes);
    result.state = run.state();
    result.state.time = 0;
    return result;
  }

  /// All irregular motions are one.
  [[nodiscard]] bool same(const Followed& a, const Followed& b) const {
    if (a.period != b.period || a.period == 0) return a.period == b.period;
    constexpr double share = 0.02;
    const double size = std::max(scale(a.last), scale(b.last));
    return (features(a.last, size) - features(b.last, size)).cwiseAbs().maxCoeff() <= share;
  }

 private:
  static constexpr int most_blocks = 60;
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

  /// Do the changes from block to block, continued geometrically, add up to nothing that matters?
  static bool settled(const std::vector<double>& changes, double scale) {
    const double last = changes.back();
    constexpr double rounding = 1e-6;
    if (last <= rounding * scale) return true;
    if (changes.size() < 2) return false;
    const double ratio = last / changes[changes.size() - 2];
    return ratio < 1 && last / (1 - ratio) <= still * scale;
  }

  [[nodiscard]] int period_of(const Block& b) const {
    for (const int period : {1, 2, 3, 4, 6})
      if (difference(b, b, period) <= 2 * still * scale(b)) return period;
    return block;
  }

  /// Irregular motions change as much late as they did before; vibrations that die out slowly change less and less.
  static bool keeps_changing(const std::vector<double>& changes) {
    const auto third = static_cast<std::ptrdiff_t>(changes.size() / 3);
    const double middle = *std::max_element(changes.end() - 2 * third, changes.end() - third);
    return *std::max_element(changes.end() - third, changes.end()) >= 0.5 * middle;
  }

  const LumpedSystem& system_;
  const SteadyProblem& problem_;
  IntegratorOptions integrator_;
  std::vector<int> meshes_;
};

/// Draws states about the static equilibrium.
class Starts {
 public:
  Starts(const LumpedSystem& system, const SteadyProblem& problem, double size) : system_(system) {
    StaticSolver solver(system);
    auto workspace = system.workspace();
    equilibrium_ = solver.solve(0, workspace);
    double rates = 0, meshes = 0;
    for (int m = 0; m < static_cast<int>(workspace.force.size()); ++m) {
      if (!system.is_whole_mesh(m)) continue;
      const auto i = static_cast<std::size_t>(m);
      size_ = std::max(size_, size * std::abs(workspace.force[i]) / workspace.stiffness[i]);
      const Eigen::VectorXd b = system.mesh_vector(m);
      rates += std::sqrt(workspace.stiffness[i] * b.dot(system.mass().llt().solve(b)));
      ++meshes;
    }
    rate_ = std::max(2 * std::numbers::pi * problem.mesh_frequency, rates / meshes);
    for (const auto& mode : modes(system, mean_stiffnesses(system)).modes)
      if (mode.frequency == 0) rigid_.push_back(mode.shape);
  }

  [[nodiscard]] SystemState draw(std::uint64_t start) const {
    return {0, equilibrium_ + size_ * random_vector(start, " displacement"),
            size_ * rate_ * random_vector(start, " velocity"), 0, 0};
  }

 private:
  /// Entries within -1 ... 1, rigid motions taken out: they would turn the system at another speed.
  [[nodiscard]] Eigen::VectorXd random_vector(std::uint64_t start, const char* quantity) const {
    constexpr std::uint64_t seed = 1;
    Eigen::VectorXd v(system_.dofs());
    for (int i = 0; i < system_.dofs(); ++i)
      v[i] = 2 * uniform_draw(seed, start, system_.names()[static_cast<std::size_t>(i)] + quantity) - 1;
    for (const auto& nu : rigid_) v -= nu * nu.dot(system_.mass() * v);
    return v;
  }

  const LumpedSystem& system_;
  double rate_ = 0, size_ = 0;
  Eigen::VectorXd equilibrium_;
  std::vector<Eigen::VectorXd> rigid_;
};

}  // namespace

double reach_of_backlash(const LumpedSystem& system, const SteadyProblem& problem) {
  const auto meshes = meshes_with_backlash(system);
  if (meshes.empty()) return 0;
  StaticSolver solver(system);
  auto workspace = system.workspace();
  (void)solver.solve(0, workspace);
  const auto count = static_cast<Eigen::Index>(system.meshes().size());
  const Eigen::VectorXd deflection = Eigen::Map<const Eigen::VectorXd>(workspace.delta.data(), count);
  const Eigen::VectorXd force = Eigen::Map<const Eigen::VectorXd>(workspace.elastic.data(), count);
  const int cycles = std::min(problem.period_in_cycles, longest_searched_period);
  SampledMeshes sampled(system, cycles / problem.mesh_frequency, static_cast<Eigen::Index>(cycles) * force_samples);
  Eigen::MatrixXd approach, rate, forces;
  sampled.at_deflection(deflection, approach, rate);
  approach = approach.colwise().mean().replicate(approach.rows(), 1).eval();
  sampled.evaluate(approach, Eigen::MatrixXd::Zero(rate.rows(), rate.cols()), forces);
  const Eigen::VectorXd swing = (forces.colwise().maxCoeff() - forces.colwise().minCoeff()).transpose() / 2;
  Eigen::VectorXd tangent = sampled.tangent().colwise().mean();
  for (Eigen::Index m = 0; m < count; ++m)
    if (!(tangent[m] > 0)) tangent[m] = mean_stiffness(system.meshes()[static_cast<std::size_t>(m)].excitation);
  const FrequencyResponse linear(system, tangent);
  Eigen::MatrixXd transfer = Eigen::MatrixXd::Zero(count, count);
  for (const auto& mode : modes(system, tangent).modes) {
    if (mode.frequency == 0) continue;
    const Eigen::MatrixXd at = linear.mesh_transfer(2 * std::numbers::pi * mode.frequency, 1);
    transfer = transfer.cwiseMax((at.leftCols(count).cwiseAbs2() + at.rightCols(count).cwiseAbs2()).cwiseSqrt());
  }
  const Eigen::VectorXd bound = transfer * swing;
  double reach = 0;
  for (const int m : meshes) {
    const double penetration = std::abs(force[m]) / tangent[m];
    if (penetration > 0) reach = std::max(reach, bound[m] / penetration);
  }
  return reach;
}

StableMotions stable_motions(const LumpedSystem& system, const SteadyProblem& problem, const SystemState& present,
                             const IntegratorOptions& integrator, const MotionSearch& search) {
  const Follower follower(system, problem, integrator);
  const Starts starts(system, problem, search.size);
  std::vector<Followed> followed(static_cast<std::size_t>(search.starts) + 1);
  for_each_task(followed.size(), search.threads,
                [&](std::size_t i) { followed[i] = follower.follow(i == 0 ? present : starts.draw(i)); });
  StableMotions result;
  result.found.starts = search.starts;
  std::vector<std::size_t> examples;
  // What is known of the present motion is that it is one, however slowly the rest of its vibrations dies out.
  if (!followed.front().decided) followed.front().period = 1;
  for (std::size_t i = 0; i < followed.size(); ++i) {
    const auto& f = followed[i];
    if (!f.decided && i > 0) {
      ++result.found.undecided;
      continue;
    }
    std::size_t number = 0;
    while (number < examples.size() && !follower.same(followed[examples[number]], f)) ++number;
    auto& motions = result.found.list;
    if (number == examples.size()) {
      examples.push_back(i);
      motions.push_back({f.period, f.largest_force(), f.last.open.maxCoeff(), 0, i == 0});
    }
    auto& motion = motions[number];
    if (i > 0) ++motion.starts;
    // Irregular motions show their largest forces now and then.
    if (f.period == 0) {
      motion.largest_force = std::max(motion.largest_force, f.largest_force());
      motion.contact_loss = std::max(motion.contact_loss, f.last.open.maxCoeff());
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

}  // namespace annulus::dynamics
