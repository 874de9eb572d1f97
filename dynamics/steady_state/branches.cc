#include "dynamics/steady_state/branches.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "core/errors.h"
#include "core/not_known.h"
#include "dynamics/modes/modes.h"
#include "dynamics/steady_state/floquet.h"
#include "dynamics/steady_state/harmonic_balance.h"
#include "dynamics/steady_state/newton_krylov.h"

namespace annulus::dynamics {

namespace {

/// The harmonic balance at one value of the input.
struct BalanceAt {
  LumpedCase lumped;
  double period;
  FrequencyResponse linear;
  BalanceProblem problem;
  HarmonicBalance balance;

  BalanceAt(LumpedCase of, const BranchOptions& options, const Eigen::VectorXd& stiffness)
      : lumped(std::move(of)),
        period(lumped.problem.period_in_cycles / lumped.problem.mesh_frequency),
        linear(lumped.system, stiffness),
        problem(
            balance_problem(lumped.system, linear, stiffness, {.period = period}, samples_of(options, lumped.problem))),
        balance(problem, samples_of(options, lumped.problem)) {}
  static Eigen::Index samples_of(const BranchOptions& options, const SteadyProblem& problem) {
    return static_cast<Eigen::Index>(options.samples_per_cycle) * problem.period_in_cycles;
  }
};

/// A point of the branch: approaches over a period (in units of a length) and the input (of the range).
struct Point {
  Eigen::VectorXd u;  ///< samples x meshes, then the input
  [[nodiscard]] double input() const { return u[u.size() - 1]; }
};

class Tracer {
 public:
  Tracer(const LumpedFamily& family, const BranchOptions& options) : family_(family), options_(options) {
    if (!(options.from != options.to) || !std::isfinite(options.from) || !std::isfinite(options.to))
      throw InputError(
          fmt::format("a branch needs two different ends of its input, not {} and {}", options.from, options.to));
    if (options.samples_per_cycle < 8 || options.samples_per_cycle % 8 != 0)
      throw InputError(
          fmt::format("a branch needs a multiple of 8 samples per mesh cycle, not {}", options.samples_per_cycle));
    const auto first = family(options.from), last = family(options.to);
    meshes_ = static_cast<Eigen::Index>(first.system.meshes().size());
    names_ = first.system.names();
    cycles_ = first.problem.period_in_cycles;
    if (first.system.has_moving_vectors())
      throw InputError(
          "branches are not found where mesh vectors move with the mesh (elastic modes of the ring); leave the elastic "
          "modes out");
    if (first.system.has_friction())
      throw InputError("branches are not found with friction on the flanks; leave the friction out");
    stiffness_ = mean_stiffnesses(first.system);
    range_ = options.to - options.from;
    for (const auto* lumped : {&first.problem, &last.problem})
      length_ = std::max(length_, lumped->force_scale / lumped->stiffness);
  }

  /// The motion at the beginning of the range. Throws SolverError where there is none.
  const Eigen::VectorXd& begin() {
    if (last_.u.size() == 0) last_ = first_point();
    return last_.u;
  }
  /// The motion at which the branch ended.
  [[nodiscard]] const Eigen::VectorXd& end() const { return last_.u; }
  /// How far two motions are apart, of five static deflections.
  [[nodiscard]] double apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return length_of((a - b).head(a.size() - 1).eval());
  }

  Branch trace() {
    Branch branch;
    (void)begin();
    add(branch, last_);
    // The first step changes the input alone, towards the end of the range.
    Eigen::VectorXd direction = Eigen::VectorXd::Unit(last_.u.size(), last_.u.size() - 1);
    double step = options_.max_step / 4;
    while (static_cast<int>(branch.points.size()) < options_.max_points) {
      auto next = advanced(last_, direction, step);
      if (!next) {
        branch.end = fmt::format("no motion follows the one at {:g} ({})", value(last_), trouble_);
        break;
      }
      direction = normalised(next->u - last_.u);
      previous_ = last_;
      last_ = *next;
      add(branch, last_);
      look_for_events(branch);
      if (last_.input() == 1 || last_.input() == 0) break;
    }
    if (static_cast<int>(branch.points.size()) == options_.max_points)
      branch.end = fmt::format("it was followed to {:g} over {} points, the limit", value(last_), options_.max_points);
    add_branchings(branch, inputs_.size() + close_by);
    return branch;
  }

 private:
  [[nodiscard]] double value(const Point& point) const { return options_.from + range_ * point.input(); }

  /// The last three are cached: the residual, its derivative with the input, and the present point.
  BalanceAt& at(double input) {
    const auto known = std::find_if(cached_.begin(), cached_.end(), [&](const auto& c) { return c.first == input; });
    if (known != cached_.end()) return *known->second;
    auto lumped = family_(options_.from + range_ * input);
    if (lumped.system.names() != names_ || static_cast<Eigen::Index>(lumped.system.meshes().size()) != meshes_ ||
        lumped.problem.period_in_cycles != cycles_)
      throw InputError(
          fmt::format("a branch needs the same degrees of freedom, meshes and period at all values; at "
                      "{:g} there are {} degrees of freedom, {} meshes and {} mesh cycles",
                      options_.from + range_ * input, lumped.system.dofs(), lumped.system.meshes().size(),
                      lumped.problem.period_in_cycles));
    if (cached_.size() == 3) cached_.erase(cached_.begin());
    cached_.emplace_back(input, std::make_unique<BalanceAt>(std::move(lumped), options_, stiffness_));
    return *cached_.back().second;
  }

  /// Residual of the harmonic balance, in units of the length.
  void residual(const Eigen::VectorXd& u, Eigen::Ref<Eigen::VectorXd> result) {
    auto& balance = at(u[u.size() - 1]).balance;
    const Eigen::Index samples = balance.samples();
    const Eigen::MatrixXd approach = length_ * u.head(samples * meshes_).reshaped(samples, meshes_);
    Eigen::MatrixXd r(samples, meshes_);
    balance.residual(approach, r);
    result = r.reshaped() / length_;
  }

  Point first_point() {
    const auto& first = at(0);
    PeriodicOptions periodic;
    periodic.samples_per_cycle = options_.samples_per_cycle;
    const auto found = periodic_response(first.lumped.system, first.period, cycles_, periodic);
    if (!found.converged) throw SolverError(fmt::format("no motion at {:g}: {}", options_.from, found.trouble));
    const Eigen::VectorXd z =
        (first.linear.mesh_vectors().transpose() * found.displacement).transpose().reshaped() / length_;
    const auto point = at_input(0, z);
    if (!point) throw SolverError(fmt::format("no motion at {:g}: {}", options_.from, trouble_));
    return *point;
  }

  /// The motion near these approaches at one input.
  std::optional<Point> at_input(double input, const Eigen::VectorXd& z) {
    const Eigen::Index size = z.size();
    Eigen::VectorXd extended(size + 1);
    const Equations equations{[&](const Eigen::VectorXd& u, Eigen::VectorXd& r) {
                                extended << u, input;
                                r.resize(size);
                                residual(extended, r);
                              },
                              [&](const Eigen::VectorXd& v, Eigen::VectorXd& product) { apply(input, v, product); }};
    const auto solved = solve_newton_krylov(equations, z, newton());
    iterations_ = solved.newton_iterations;
    trouble_ = solved.trouble;
    if (!solved.converged) return std::nullopt;
    Point point{Eigen::VectorXd(size + 1)};
    point.u << solved.u, input;
    return point;
  }

  static NewtonKrylovOptions newton() { return {.tolerance = 1e-7, .weight = 1, .max_iterations = 12}; }

  /// Derivative with the approaches at the last residual.
  void apply(double input, const Eigen::VectorXd& v, Eigen::VectorXd& product) {
    auto& balance = at(input).balance;
    const Eigen::Index samples = balance.samples();
    const Eigen::MatrixXd change = v.head(samples * meshes_).reshaped(samples, meshes_);
    Eigen::MatrixXd r(samples, meshes_);
    balance.apply_derivative(change, r);
    product = r.reshaped();
  }

  /// Weights of the arc: motions count by their root mean square over five static deflections.
  [[nodiscard]] Eigen::VectorXd weighted(const Eigen::VectorXd& u) const {
    constexpr double deflections = 5;
    Eigen::VectorXd w = u;
    w.head(u.size() - 1) /= deflections * std::sqrt(static_cast<double>(u.size() - 1) / static_cast<double>(meshes_));
    return w;
  }
  [[nodiscard]] double length_of(const Eigen::VectorXd& u) const { return weighted(u).norm(); }
  [[nodiscard]] Eigen::VectorXd normalised(const Eigen::VectorXd& u) const { return u / length_of(u); }

  /// The point at this distance along the branch.
  std::optional<Point> corrected(const Point& from, const Eigen::VectorXd& direction, double step) {
    Eigen::VectorXd predicted = from.u + step * direction;
    if (const double input = predicted[predicted.size() - 1]; input >= 1 || input <= 0)
      return at_end(from, direction, input >= 1 ? 1 : 0, step);
    const Eigen::VectorXd normal = weighted(weighted(direction));
    const Eigen::Index size = predicted.size() - 1;
    Eigen::VectorXd with_input(size);
    const Equations equations{[&](const Eigen::VectorXd& u, Eigen::VectorXd& r) {
                                r.resize(size + 1);
                                at_ = u[size];
                                if (u[size] < 0 || u[size] > 1) {
                                  // Beyond the range the system may not exist: a shorter step is taken.
                                  r.setConstant(not_known);
                                  return;
                                }
                                const double change = u[size] < 0.5 ? 1e-6 : -1e-6;
                                Eigen::VectorXd there = u;
                                there[size] += change;
                                residual(there, with_input);
                                residual(u, r.head(size));
                                with_input = (with_input - r.head(size)) / change;
                                r[size] = normal.dot(u - predicted);
                              },
                              [&](const Eigen::VectorXd& v, Eigen::VectorXd& product) {
                                Eigen::VectorXd part;
                                apply(at_, v, part);
                                product.resize(size + 1);
                                product.head(size) = part + v[size] * with_input;
                                product[size] = normal.dot(v);
                              }};
    try {
      const auto solved = solve_newton_krylov(equations, predicted, newton());
      iterations_ = solved.newton_iterations;
      trouble_ = solved.trouble;
      // A far jump lands on another branch.
      if (!solved.converged || length_of(solved.u - predicted) > step) return std::nullopt;
      return Point{solved.u};
    } catch (const SolverError& error) {
      trouble_ = error.what();
      return std::nullopt;
    }
  }

  /// The point at an end of the range, where the direction reaches it within the step.
  std::optional<Point> at_end(const Point& from, const Eigen::VectorXd& direction, double input, double step) {
    const Eigen::Index size = direction.size() - 1;
    const double share = (input - from.input()) / direction[size];
    const Eigen::VectorXd predicted = from.u + share * direction;
    try {
      auto point = at_input(input, predicted.head(size));
      if (!point || length_of(point->u - predicted) > step) return std::nullopt;
      return point;
    } catch (const SolverError& error) {
      trouble_ = error.what();
      return std::nullopt;
    }
  }

  /// The next point, with steps that Newton's method can take; `step` is adapted for the one after.
  std::optional<Point> advanced(const Point& from, const Eigen::VectorXd& direction, double& step) {
    constexpr double shortest = 1e-6;
    for (; step >= shortest; step /= 2) {
      const auto next = corrected(from, direction, step);
      if (!next) continue;
      // Around a bend the steps are short enough for parabolas.
      constexpr double bend = 0.9;
      const Eigen::VectorXd turned = normalised(next->u - from.u);
      const double cosine = weighted(turned).dot(weighted(direction));
      if (cosine < bend && step > options_.max_step / 64) continue;
      const double taken = step;
      if (iterations_ <= 4 && cosine > 0.98) step = std::min(2 * taken, options_.max_step);
      return next;
    }
    return std::nullopt;
  }

  /// Largest force, loss of contact and stability of a point.
  void add(Branch& branch, const Point& point) {
    auto& here = at(point.input());
    const Eigen::Index samples = here.balance.samples();
    const Eigen::MatrixXd approach = length_ * point.u.head(samples * meshes_).reshaped(samples, meshes_);
    Eigen::MatrixXd rest(samples, meshes_), force;
    here.balance.residual(approach, rest);
    multipliers_.push_back(floquet_multipliers(here.lumped.system, stiffness_, here.balance.meshes(), here.period));
    std::vector<LumpedSystem::Contact> contact;
    here.balance.meshes().evaluate_at_instants(approach, here.balance.rate_of(approach), force, contact);
    BranchPoint result{.input = value(point)};
    for (Eigen::Index m = 0; m < meshes_; ++m) {
      if (!here.lumped.system.is_gear_mesh(static_cast<int>(m))) continue;
      result.largest_force = std::max(result.largest_force, force.col(m).cwiseAbs().maxCoeff());
      const auto begin = contact.begin() + m * samples;
      result.contact_loss = std::max(
          result.contact_loss, static_cast<double>(std::count(begin, begin + samples, LumpedSystem::Contact::open)) /
                                   static_cast<double>(samples));
    }
    const auto& all = multipliers_.back();
    result.multiplier = all.size() > 0 ? std::abs(all[0]) : 0;
    result.stable = result.multiplier <= 1 + edge;
    branch.points.push_back(result);
    inputs_.push_back(point.input());
    arcs_.push_back(arcs_.empty() ? 0 : arcs_.back() + length_of(point.u - previous_.u));
  }

  /// How a multiplier may pass the unit circle.
  enum class Passing : std::size_t { plus_one, minus_one, complex };
  static Passing kind_of(const std::complex<double>& multiplier) {
    constexpr double real = 1e-6;
    if (std::abs(multiplier.imag()) > real * std::abs(multiplier)) return Passing::complex;
    return multiplier.real() > 0 ? Passing::plus_one : Passing::minus_one;
  }
  /// Numbers of multipliers outside the unit circle, by their kinds.
  using Outside = std::array<int, 3>;
  static int of(const Outside& outside, Passing kind) { return outside.at(static_cast<std::size_t>(kind)); }
  static Outside outside(const Eigen::VectorXcd& multipliers) {
    Outside count{};
    for (const auto& m : multipliers)
      if (std::abs(m) > 1 + edge) ++count.at(static_cast<std::size_t>(kind_of(m)));
    return count;
  }

  /// Where a multiplier of this kind passes, linearly between the last two points, with half the distance as error; all
  /// of it where there is none of this kind on one side.
  [[nodiscard]] std::pair<double, double> passing(Passing kind) const {
    const std::size_t n = inputs_.size();
    const auto beyond = [&](const Eigen::VectorXcd& multipliers) {
      double largest = 0;
      for (const auto& m : multipliers)
        if (kind_of(m) == kind) largest = std::max(largest, std::abs(m));
      return largest - 1;
    };
    const double x = beyond(multipliers_[n - 2]), y = beyond(multipliers_[n - 1]);
    const double distance = std::abs(range_ * (inputs_[n - 1] - inputs_[n - 2]));
    const bool known = x * y < 0 && std::min(x, y) > -1;
    const double share = known ? x / (x - y) : 0.5;
    return {options_.from + range_ * (inputs_[n - 2] + share * (inputs_[n - 1] - inputs_[n - 2])),
            known ? distance / 2 : distance};
  }

  void look_for_events(Branch& branch) {
    const std::size_t n = inputs_.size();
    if (n >= 3) {
      const double a = inputs_[n - 2] - inputs_[n - 3], b = inputs_[n - 1] - inputs_[n - 2];
      if (a * b < 0) branch.events.push_back(fold(n - 2));
    }
    if (n < 2) return;
    const auto before = outside(multipliers_[n - 2]), now = outside(multipliers_[n - 1]);
    const auto changes = [&](Passing kind) { return of(before, kind) != of(now, kind); };
    // Multipliers outside the unit circle may meet and part: their number does not change then.
    if (std::accumulate(before.begin(), before.end(), 0) != std::accumulate(now.begin(), now.end(), 0)) {
      const auto add_event = [&](BranchEvent::Kind event, Passing kind) {
        const auto [input, error] = passing(kind);
        branch.events.push_back({event, input, error, n - 2});
      };
      if (changes(Passing::minus_one)) add_event(BranchEvent::Kind::period_doubling, Passing::minus_one);
      if (changes(Passing::complex)) add_event(BranchEvent::Kind::neimark_sacker, Passing::complex);
      if (changes(Passing::plus_one)) unexplained_.push_back(n - 1);
    }
    add_branchings(branch, n);
  }

  /// A fold changes a multiplier of +1 a step earlier or later; what no fold explains by now is a branching.
  void add_branchings(Branch& branch, std::size_t n) {
    while (!unexplained_.empty() && n > unexplained_.front() + close_by) {
      const std::size_t at = unexplained_.front();
      unexplained_.erase(unexplained_.begin());
      const bool folded = std::any_of(branch.events.begin(), branch.events.end(), [&](const BranchEvent& e) {
        return e.kind == BranchEvent::Kind::fold && e.before + close_by >= at && e.before <= at + close_by;
      });
      if (!folded)
        branch.events.push_back({BranchEvent::Kind::branching, options_.from + range_ * inputs_[at],
                                 std::abs(range_ * (inputs_[at] - inputs_[at - 1])), at - 1});
    }
  }

  /// The turning point near point i by the parabola through it and its neighbours over the arc.
  [[nodiscard]] BranchEvent fold(std::size_t i) const {
    const double s0 = arcs_[i - 1], s1 = arcs_[i], s2 = arcs_[i + 1];
    const double p0 = inputs_[i - 1], p1 = inputs_[i], p2 = inputs_[i + 1];
    const double d01 = (p1 - p0) / (s1 - s0), d12 = (p2 - p1) / (s2 - s1), curvature = (d12 - d01) / (s2 - s0);
    const double s = curvature == 0 ? s1 : (s0 + s1) / 2 - d01 / (2 * curvature);
    const double at = p0 + (s - s0) * (d01 + curvature * (s - s1));
    return {BranchEvent::Kind::fold, options_.from + range_ * at, std::abs(range_ * (at - p1)), s < s1 ? i - 1 : i};
  }

  const LumpedFamily& family_;
  const BranchOptions& options_;
  Eigen::Index meshes_ = 0;
  int cycles_ = 0;
  std::vector<std::string> names_;
  Eigen::VectorXd stiffness_;
  double range_ = 0, length_ = 0;
  std::vector<std::pair<double, std::unique_ptr<BalanceAt>>> cached_;
  double at_ = 0;  // input of the last residual
  int iterations_ = 0;
  std::string trouble_;
  Point previous_, last_;
  std::vector<double> inputs_, arcs_;
  std::vector<Eigen::VectorXcd> multipliers_;
  static constexpr double edge = 1e-6;        // of the unit circle: rounding of multipliers
  static constexpr std::size_t close_by = 2;  // points
  std::vector<std::size_t> unexplained_;      // points before which a multiplier passed +1, without a fold so far
};

}  // namespace

const char* to_string(BranchEvent::Kind kind) {
  switch (kind) {
    case BranchEvent::Kind::fold:
      return "fold";
    case BranchEvent::Kind::period_doubling:
      return "period doubling";
    case BranchEvent::Kind::neimark_sacker:
      return "Neimark-Sacker";
    case BranchEvent::Kind::branching:
      break;
  }
  return "branching";
}

namespace {

/// Adds to the error of every fold its distance from the nearest one with half the samples.
void compare_folds(const LumpedFamily& family, const BranchOptions& options, Branch& branch) {
  if (std::none_of(branch.events.begin(), branch.events.end(),
                   [](const BranchEvent& e) { return e.kind == BranchEvent::Kind::fold; }))
    return;
  auto coarser = options;
  coarser.samples_per_cycle = options.samples_per_cycle / 2;
  std::vector<double> folds;
  try {
    if (coarser.samples_per_cycle % 8 == 0)
      for (const auto& event : trace_branch(family, coarser).events)
        if (event.kind == BranchEvent::Kind::fold) folds.push_back(event.input);
  } catch (const SolverError&) {  // the errors are not known then
  }
  for (auto& event : branch.events) {
    if (event.kind != BranchEvent::Kind::fold) continue;
    double nearest = folds.empty() ? not_known : std::abs(folds.front() - event.input);
    for (const double fold : folds) nearest = std::min(nearest, std::abs(fold - event.input));
    event.error += nearest;
  }
}

}  // namespace

std::vector<Branch> branches_between(const LumpedFamily& family, const BranchOptions& options) {
  std::vector<Branch> list;
  std::string trouble;
  auto back = options;
  std::swap(back.from, back.to);
  Tracer there(family, options), from_end(family, back);
  try {
    list.push_back(there.trace());
    compare_folds(family, options, list.back());
  } catch (const SolverError& error) {
    trouble = error.what();
  }
  try {
    constexpr double same = 0.01;
    const auto& begin = from_end.begin();
    const bool arrives = !list.empty() && list.front().end.empty() && list.front().points.back().input == options.to &&
                         there.apart(there.end(), begin) <= same;
    if (!arrives) {
      list.push_back(from_end.trace());
      compare_folds(family, back, list.back());
    }
  } catch (const SolverError& error) {
    if (list.empty()) throw SolverError(trouble + "; " + error.what());
  }
  return list;
}

Branch trace_branch(const LumpedFamily& family, const BranchOptions& options) {
  return Tracer(family, options).trace();
}

}  // namespace annulus::dynamics
