#include "dynamics/steady_state/piecewise_response.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "core/errors.h"
#include "dynamics/modes/dense_spectrum.h"
#include "dynamics/steady_state/piecewise_system.h"

namespace annulus::dynamics {

namespace {

/// An interval without jump.
struct SmoothPiece {
  double begin = 0, end = 0;  // s
  int combination = 0;
};

bool whole_number(double x) { return std::abs(x - std::round(x)) <= 1e-9 * std::max(1.0, std::abs(x)); }

std::vector<SmoothPiece> pieces_of(const LumpedSystem& system, PiecewiseSystem& linear, double period) {
  std::vector<SmoothPiece> pieces;
  const double instant = 1e-12 * period;
  for (double t = 0; t < period;) {
    double end = std::min(system.next_jump(t), period);
    if (period - end < instant) end = period;
    pieces.push_back({t, end, linear.combination((t + end) / 2)});
    t = end;
  }
  return pieces;
}

/// Least value within a step of the cubic through both ends and their slopes.
double hermite_minimum(double a, double slope_a, double b, double slope_b, double step) {
  const double ends = std::min(a, b);
  if (!(slope_a < 0 && slope_b > 0)) return ends;
  // p(x) = a + s x + c x^2 + d x^3, x in [0, 1]
  const double s = slope_a * step, rise = b - a, c = 3 * rise - 2 * s - slope_b * step,
               d = s + slope_b * step - 2 * rise;
  const double root = std::sqrt(std::max(0.0, c * c - 3 * d * s));
  const double x = -s / (c + root);
  return x > 0 && x < 1 ? std::min(ends, a + x * (s + x * (c + x * d))) : ends;
}

/// Phi and the particular solution from rest over the pieces.
class PiecewisePeriodMap {
 public:
  PiecewisePeriodMap(PiecewiseSystem& linear, const std::vector<SmoothPiece>& pieces)
      : linear_(linear), known_(linear.inner() + linear.rigid()) {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(linear.size());
    Eigen::MatrixXd next;
    monodromy_.setIdentity(known_, known_);
    for (const auto& piece : pieces) {
      const auto& step = linear.propagator(piece.combination, piece.end - piece.begin);
      linear.set_excitation(piece.begin, z);
      z.head(known_) = step.topRows(known_) * z;
      next.noalias() = step.topLeftCorner(known_, known_) * monodromy_;
      monodromy_.swap(next);
    }
    particular_ = z.head(known_);
  }

  /// Periodic state at time 0; rigid displacements zero. Returns the residual, relative.
  double solve(Eigen::VectorXd& z) const {
    const Eigen::Index inner = linear_.inner();
    // Nothing depends on rigid displacements: their columns are zero, and as many rows are redundant.
    const Eigen::MatrixXd matrix = (Eigen::MatrixXd::Identity(known_, known_) - monodromy_).leftCols(inner);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(matrix);
    z.setZero(linear_.size());
    z.head(inner) = factor.solve(particular_);
    const Eigen::VectorXd rest = matrix * z.head(inner) - particular_;
    return rest.norm() / std::max(particular_.norm(), std::numeric_limits<double>::min());
  }

  [[nodiscard]] double largest_multiplier() const {
    const Eigen::Index inner = linear_.inner();
    Eigen::MatrixXd map = monodromy_.topLeftCorner(inner, inner);
    // A conserved momentum is a multiplier of exactly one, without meaning for stability: moved to zero (Wielandt).
    const Eigen::MatrixXd& rows = linear_.conserved();
    if (rows.size() > 0) {
      const Eigen::MatrixXd right = rows.transpose() * (rows * rows.transpose()).inverse();
      map -= right * rows;
    }
    return eigenvalues(map, "the Floquet multipliers").cwiseAbs().maxCoeff();
  }

 private:
  PiecewiseSystem& linear_;
  Eigen::Index known_;
  Eigen::MatrixXd monodromy_;
  Eigen::VectorXd particular_;
};

/// Goes through the period once from the periodic state and stores the results.
class PeriodWalk {
 public:
  /// Angle of the fastest mode between points: cubics and parabolas are accurate to 1e-4 of its amplitude.
  static constexpr double radians = 0.25;

  PeriodWalk(const LumpedSystem& system, PiecewiseSystem& linear, double period, Eigen::Index samples,
             PiecewiseResponse& response)
      : system_(system), linear_(linear), response_(response), step_(period / static_cast<double>(samples)) {
    fine_ = std::max(1, static_cast<int>(std::ceil(step_ * linear.fastest() / radians)));
    const auto meshes = static_cast<Eigen::Index>(system.meshes().size());
    response.time.resize(samples);
    response.force.resize(meshes, samples);
    states_.resize(linear.size(), samples);
    response.dense_force.resize(meshes, samples * fine_);
    response.dense_per_sample = fine_;
    response.least_penetration = std::numeric_limits<double>::infinity();
  }

  void run(const std::vector<SmoothPiece>& pieces, Eigen::VectorXd z) {
    const auto jumps = static_cast<Eigen::Index>(pieces.size());
    const Eigen::Index meshes = response_.force.rows(), samples = states_.cols();
    const double h = step_ / fine_;
    long long next = 0;  // fine step
    response_.jump_time.resize(jumps);
    response_.force_before.resize(meshes, jumps);
    response_.force_after.resize(meshes, jumps);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const auto& piece = pieces[i];
      linear_.set_excitation(piece.begin, z);
      const Eigen::VectorXd begin = z;
      response_.jump_time[static_cast<Eigen::Index>(i)] = piece.begin;
      response_.force_after.col(static_cast<Eigen::Index>(i)) = linear_.force(piece.combination) * z;
      note(z, 0);
      if (i > 0) response_.dense_after_jump.push_back(static_cast<Eigen::Index>(next));
      double t = piece.begin;
      const auto at = [&](long long k) { return static_cast<double>(k) * h; };
      for (; next < samples * fine_ && at(next) < piece.end - 1e-6 * h; ++next) {
        const double ahead = at(next) - t;
        if (ahead > 1e-6 * h) {
          // Steps of the fine grid are all one duration.
          const bool whole = std::abs(ahead - h) < 1e-6 * h;
          z = linear_.propagator(piece.combination, whole ? h : ahead) * z;
          t = at(next);
          linear_.set_excitation(t, z);  // no drift of the known part
          note(z, ahead);
        }
        auto force = response_.dense_force.col(static_cast<Eigen::Index>(next));
        force.noalias() = linear_.force(piece.combination) * z;
        if (next % fine_ == 0) {
          const auto sample = static_cast<Eigen::Index>(next / fine_);
          response_.time[sample] = at(next);
          response_.force.col(sample) = force;
          states_.col(sample) = z;
        }
      }
      const double ahead = piece.end - t;
      z = linear_.propagator(piece.combination, piece.end - piece.begin) * begin;
      linear_.set_excitation(piece.end, z);
      note(z, ahead);
      const auto following = static_cast<Eigen::Index>((i + 1) % pieces.size());
      response_.force_before.col(following) = linear_.force(piece.combination) * z;
    }
  }

  void set_motion() {
    const Eigen::Index n = system_.dofs(), r = linear_.rigid();
    auto rigid_part = states_.middleRows(linear_.inner(), r);
    rigid_part.colwise() -= rigid_part.rowwise().mean().eval();
    response_.displacement.resize(n, states_.cols());
    response_.velocity.resize(n, states_.cols());
    for (Eigen::Index i = 0; i < states_.cols(); ++i) {
      response_.displacement.col(i) = linear_.displacement(states_.col(i));
      response_.velocity.col(i) = linear_.velocity(states_.col(i));
    }
  }

 private:
  /// Searches for the least penetration between the last state, `ahead` seconds before, and this one.
  void note(const Eigen::VectorXd& z, double ahead) {
    now_.noalias() = linear_.penetration() * z;
    slope_.noalias() = linear_.penetration_rate() * z;
    for (Eigen::Index m = 0; m < now_.size(); ++m) {
      if (system_.meshes()[m].half_backlash.value_or(0.0) == 0) continue;  // a linear mesh never loses contact
      const double least = ahead > 0 ? hermite_minimum(last_[m], last_slope_[m], now_[m], slope_[m], ahead) : now_[m];
      if (least >= response_.least_penetration) continue;
      response_.least_penetration = least;
      response_.least_mesh = static_cast<int>(m);
    }
    last_.swap(now_);
    last_slope_.swap(slope_);
  }

  const LumpedSystem& system_;
  PiecewiseSystem& linear_;
  PiecewiseResponse& response_;
  double step_ = 0;
  int fine_ = 1;
  Eigen::MatrixXd states_;
  Eigen::VectorXd now_, slope_, last_, last_slope_;
};

void repeat_period(PeriodicResponse& p, double period, int times) {
  const Eigen::Index n = p.time.size();
  Eigen::VectorXd time(n * times);
  for (int i = 0; i < times; ++i) time.segment(i * n, n) = p.time.array() + i * period;
  p.time = std::move(time);
  for (auto* columns : {&p.force, &p.displacement, &p.velocity}) *columns = columns->replicate(1, times).eval();
}

void judge(const LumpedSystem& system, PiecewiseResponse& response) {
  // Rounding: some 1e-16 x the condition of I - Phi, the inverse of the damping over a period.
  constexpr double accuracy = 1e-9;
  // Undamped motions stay on the unit circle to rounding.
  response.stable = *response.largest_multiplier <= 1 + accuracy;
  if (!(response.residual <= accuracy) || !response.force.allFinite())
    response.trouble =
        fmt::format("no periodic state: residual {:.1e} (a parametric resonance without damping)", response.residual);
  else if (!response.stable)
    response.trouble = fmt::format("parametric resonance: the periodic motion is unstable (Floquet multiplier {:.4g})",
                                   *response.largest_multiplier);
  else if (!(response.least_penetration > 0))
    response.trouble = fmt::format("{} loses contact (by {:.3g} um), which the piecewise solution does not follow",
                                   system.meshes()[response.least_mesh].name, -1e6 * response.least_penetration);
  response.converged = response.trouble.empty();
}

constexpr double most_points = 2e6;  // of every mesh: some hundred megabytes

/// Without turning errors the excitation often repeats earlier than asked for.
int cycles_to_solve(const LumpedSystem& system, const PiecewiseSystem& linear, double period, int cycles) {
  return !linear.errors_turn() && why_not_piecewise(system, period / cycles).empty() ? 1 : cycles;
}

}  // namespace

std::string why_not_piecewise(const LumpedSystem& system, double period) {
  if (system.meshes().empty()) return "there is no mesh";
  if (system.has_moving_vectors()) return "mesh vectors move with the mesh";
  if (system.has_friction()) return "friction acts on the flanks";
  if (!system.couplings().empty()) return "meshes act on each other through a common body";
  if (!system.laws().empty()) return "bearings have clearance or rolling elements";
  if (!system.faces().empty()) return "meshes are spread over their faces";
  if (!system.harmonic_loads().empty()) return "loads change in time";
  for (const auto& mesh : system.meshes()) {
    const bool wave = std::holds_alternative<RectangularStiffness>(mesh.excitation);
    if (!wave && !std::holds_alternative<ConstantStiffness>(mesh.excitation))
      return "the stiffness of " + mesh.name + " changes continuously";
    if (!mesh.tooth_errors.empty()) return "the error of " + mesh.name + " changes from tooth to tooth";
    if (wave && !whole_number(mesh.frequency * period)) return "the stiffness of " + mesh.name + " does not repeat";
    for (const auto& e : mesh.errors)
      if (e.amount != 0 && !whole_number(e.rate * period / (2 * std::numbers::pi)))
        return "the errors of " + mesh.name + " do not repeat";
  }
  return {};
}

bool too_fast_for_piecewise(const LumpedSystem& system, double period, int cycles) {
  const PiecewiseSystem linear(system);
  const double solved = period * cycles_to_solve(system, linear, period, cycles) / cycles;
  return solved * linear.fastest() / PeriodWalk::radians > most_points;
}

PiecewiseResponse piecewise_response(const LumpedSystem& system, double period, int cycles, int samples_per_cycle) {
  if (!(period > 0) || cycles < 1)
    throw InputError(fmt::format("a periodic response needs a positive period of whole cycles, not {} s and {} cycles",
                                 period, cycles));
  if (samples_per_cycle < 1)
    throw InputError(fmt::format("a periodic response needs a sample per mesh cycle, not {}", samples_per_cycle));
  PiecewiseResponse response;
  response.method = PeriodicMethod::piecewise;
  response.samples_per_cycle = samples_per_cycle;
  response.trouble = why_not_piecewise(system, period);
  if (!response.trouble.empty()) return response;
  PiecewiseSystem linear(system);
  if (!linear.neutral()) {
    response.trouble = "terms of the rotating frame act on the rigid motions of the system";
    return response;
  }
  response.solved_cycles = cycles_to_solve(system, linear, period, cycles);
  const double solved = response.solved_cycles == cycles ? period : period / cycles;
  const auto pieces = pieces_of(system, linear, solved);
  const Eigen::Index samples = static_cast<Eigen::Index>(response.solved_cycles) * samples_per_cycle;
  const double points = solved * linear.fastest() / PeriodWalk::radians;
  if (points > most_points) {
    response.trouble = fmt::format(
        "the fastest motion is too fast for the period: it needs {:.2g} points of every mesh; at most {:.2g} are "
        "possible",
        points, most_points);
    return response;
  }
  const PiecewisePeriodMap map(linear, pieces);
  Eigen::VectorXd start;
  response.residual = map.solve(start);
  response.largest_multiplier = map.largest_multiplier();
  PeriodWalk walk(system, linear, solved, samples, response);
  walk.run(pieces, start);
  walk.set_motion();
  response.solved = true;
  judge(system, response);
  response.open = response.back = Eigen::VectorXd::Zero(response.force.rows());
  if (response.solved_cycles < cycles) repeat_period(response, solved, cycles);
  return response;
}

}  // namespace annulus::dynamics
