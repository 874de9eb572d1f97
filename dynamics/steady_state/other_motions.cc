#include "dynamics/steady_state/other_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "core/errors.h"
#include "core/floating_point.h"
#include "core/parallel.h"
#include "dynamics/modes/modes.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/statistics/sampling.h"
#include "dynamics/steady_state/frequency_response.h"
#include "dynamics/steady_state/real_transform.h"
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
constexpr int force_samples = 64;

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
  Follower(const LumpedSystem& system, const SteadyProblem& problem, const IntegratorOptions& integrator)
      : system_(system), problem_(problem), integrator_(integrator), meshes_(meshes_with_backlash(system)) {}

  [[nodiscard]] Followed follow(const SystemState& start) const {
    ResponseRun run(system_, problem_.mesh_frequency, force_samples, integrator_);
    run.start_from(start.q, start.v);
    Followed result;
    std::vector<double> changes;
    for (int i = 0; i < most_blocks && !result.decided; ++i) {
      Block now = advanced(run);
      if (i > 0) changes.push_back(difference(now, result.last, 0));
      // A motion may pass close to an unstable one: one agreement is none.
      result.decided = changes.size() > 2 && settled(changes, 0, scale(now)) && settled(changes, 1, scale(now));
      result.last = std::move(now);
    }
    result.state = run.state();
    result.state.time = 0;
    if (result.decided)
      result.period = period_of(result.last);
    else
      result.decided = keeps_changing(changes, scale(result.last)) && parts(result.state);
    return result;
  }

  /// All irregular motions are one.
  [[nodiscard]] bool same(const Followed& a, const Followed& b) const {
    if (a.period == 0 || b.period == 0) return a.period == b.period;
    constexpr double share = 0.02;
    const double size = std::max(scale(a.last), scale(b.last));
    const auto x = features(a.last, size), y = features(b.last, size);
    for (std::size_t m = 0; m < x.size(); ++m)
      for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(x[m].at(i) - y[m].at(i)) > share) return false;
    return true;
  }

 private:
  static constexpr int most_blocks = 24;
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
};

/// Draws states about the static equilibrium.
class Starts {
 public:
  Starts(const LumpedSystem& system, const SteadyProblem& problem, double size)
      : system_(system), size_(size), deflection_(problem.force_scale / problem.stiffness) {
    StaticSolver solver(system);
    auto workspace = system.workspace();
    equilibrium_ = solver.solve(0, workspace);
    double rates = 0, meshes = 0;
    for (int m = 0; m < static_cast<int>(workspace.force.size()); ++m) {
      if (!system.is_whole_mesh(m)) continue;
      const auto i = static_cast<std::size_t>(m);
      deflection_ = std::max(deflection_, std::abs(workspace.force[i]) / workspace.stiffness[i]);
      const Eigen::VectorXd b = system.mesh_vector(m);
      rates += std::sqrt(workspace.stiffness[i] * b.dot(system.mass().llt().solve(b)));
      ++meshes;
    }
    rate_ = std::max(2 * std::numbers::pi * problem.mesh_frequency, rates / meshes);
    for (const auto& mode : modes(system, mean_stiffnesses(system)).modes)
      if (mode.frequency == 0) rigid_.push_back(mode.shape);
  }

  [[nodiscard]] SystemState draw(std::uint64_t start) const {
    const double size = size_ * deflection_;
    return {0, equilibrium_ + size * random_vector(start, " displacement"),
            size * rate_ * random_vector(start, " velocity"), 0, 0};
  }
  /// The same state a little beside.
  [[nodiscard]] SystemState beside(SystemState state) const {
    constexpr double little = 0.01;
    state.time = 0;
    state.q += little * deflection_ * random_vector(0, " displacement");
    return state;
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
  double size_, deflection_, rate_ = 0;
  Eigen::VectorXd equilibrium_;
  std::vector<Eigen::VectorXd> rigid_;
};

}  // namespace

namespace {

double bound_over_deflection(const LumpedSystem& system, const SteadyProblem& problem, const std::vector<int>& meshes) {
  const auto count = static_cast<Eigen::Index>(system.meshes().size());
  const int cycles = std::min(problem.period_in_cycles, longest_searched_period);
  const double period = cycles / problem.mesh_frequency;
  constexpr int most_positions = 400, per_cycle = 16;
  const int positions = std::min(per_cycle * cycles, most_positions);
  const auto path = static_path(system, Eigen::VectorXd::LinSpaced(positions, 0, period * (positions - 1) / positions));
  StaticSolver solver(system);
  auto workspace = system.workspace();
  (void)solver.solve(0, workspace);
  const Eigen::VectorXd deflection = Eigen::Map<const Eigen::VectorXd>(workspace.delta.data(), count);
  SampledMeshes sampled(system, period, static_cast<Eigen::Index>(cycles) * force_samples);
  Eigen::MatrixXd approach, rate, forces;
  sampled.at_deflection(deflection, approach, rate);
  approach = approach.colwise().mean().replicate(approach.rows(), 1).eval();
  sampled.evaluate(approach, Eigen::MatrixXd::Zero(rate.rows(), rate.cols()), forces);
  Eigen::VectorXd tangent = sampled.tangent().colwise().mean();
  for (Eigen::Index m = 0; m < count; ++m)
    if (!(tangent[m] > 0)) tangent[m] = mean_stiffness(system.meshes()[static_cast<std::size_t>(m)].excitation);
  const FrequencyResponse linear(system, tangent);
  // Harmonics of the forces, each at the natural frequencies that a change of the speed by a factor of three brings it
  // to.
  const Eigen::Index samples = forces.rows();
  const RealTransform transform(static_cast<int>(samples));
  Eigen::MatrixXcd lines(samples / 2 + 1, count);
  for (Eigen::Index m = 0; m < count; ++m) transform.forward(forces.col(m).data(), lines.col(m).data());
  lines *= 2.0 / static_cast<double>(samples);
  constexpr double lowest = 0.3, highest = 3;
  Eigen::VectorXd bound = Eigen::VectorXd::Zero(count);
  for (const auto& mode : modes(system, tangent).modes) {
    if (mode.frequency == 0) continue;
    const Eigen::MatrixXd at = linear.mesh_transfer(2 * std::numbers::pi * mode.frequency, 1);
    const Eigen::MatrixXcd transfer = at.leftCols(count) + std::complex<double>(0, 1) * at.rightCols(count);
    const double line = mode.frequency * period;
    const auto first = static_cast<Eigen::Index>(std::max(1.0, std::ceil(lowest * line)));
    const auto last = static_cast<Eigen::Index>(std::min(static_cast<double>(samples / 2 - 1), highest * line));
    for (Eigen::Index h = first; h <= last; ++h)
      bound = bound.cwiseMax((transfer * lines.row(h).transpose()).cwiseAbs());
  }
  double reach = 0;
  for (const int m : meshes) {
    const double smallest = path.force.row(m).cwiseAbs().minCoeff();
    constexpr double nothing = 1e-6;
    const double here = smallest > nothing * problem.force_scale ? bound[m] * tangent[m] / smallest
                                                                 : std::numeric_limits<double>::infinity();
    if (std::isnan(here)) return std::numeric_limits<double>::infinity();
    reach = std::max(reach, here);
  }
  return reach;
}

}  // namespace

double reach_of_backlash(const LumpedSystem& system, const SteadyProblem& problem) {
  const auto meshes = meshes_with_backlash(system);
  if (meshes.empty()) return 0;
  const UntrappedFloatingPoint untrapped;  // the response of undamped systems is not bounded
  try {
    return bound_over_deflection(system, problem, meshes);
  } catch (const SolverError&) {
    return std::numeric_limits<double>::infinity();
  }
}

StableMotions stable_motions(const LumpedSystem& system, const SteadyProblem& problem, const SystemState& present,
                             bool steady, const IntegratorOptions& integrator, const MotionSearch& search) {
  const Follower follower(system, problem, integrator);
  const Starts starts(system, problem, search.size);
  std::vector<Followed> followed(static_cast<std::size_t>(search.starts) + 1);
  for_each_task(followed.size(), search.threads, [&](std::size_t i) {
    try {
      followed[i] = follower.follow(i == 0 ? starts.beside(present) : starts.draw(i));
    } catch (const SolverError&) {  // one start that the integrator cannot follow is not decided
      followed[i].decided = false;
    }
  });
  StableMotions result;
  result.found.starts = search.starts;
  std::vector<std::size_t> examples;
  for (std::size_t i = 0; i < followed.size(); ++i) {
    const auto& f = followed[i];
    if (!f.decided) {
      // A steady motion is one, however slowly the rest of its vibrations dies out.
      const bool known = i == 0 && steady && f.last.high.size() > 0;
      if (i > 0) ++result.found.undecided;
      if (!known) continue;
      followed[i].period = 1;
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
