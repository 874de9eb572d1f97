#include "dynamics/systems/planetary/response_evaluation.h"

#include <algorithm>
#include <cmath>

#include "dynamics/figures/peaks.h"
#include "dynamics/systems/planetary/load_sharing.h"

namespace annulus::dynamics {

namespace {

Peak sharing_peak(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  const double sampled = load_sharing_instantaneous(force);
  if (!std::isfinite(sampled)) return {sampled, sampled};
  Peak peak = peak_of_rows(load_sharing_over_time(force));
  // Where one branch after the other carries the whole load, parabolas overshoot the largest possible share.
  if (force.minCoeff() >= 0)
    peak.refined = std::max(peak.sampled, std::min(peak.refined, static_cast<double>(force.rows())));
  return peak;
}

/// Forces averaged over the mesh cycle that begins at each sample.
Peak averaged_peak(const Eigen::Ref<const Eigen::MatrixXd>& force, int samples_per_cycle) {
  Eigen::MatrixXd mean(force.rows(), force.cols() - samples_per_cycle + 1);
  // Sliding accumulates rounding of about columns x eps, far below any use.
  Eigen::VectorXd sum = force.leftCols(samples_per_cycle).rowwise().sum();
  mean.col(0) = sum;
  for (Eigen::Index i = 1; i < mean.cols(); ++i) {
    sum += force.col(i + samples_per_cycle - 1) - force.col(i - 1);
    mean.col(i) = sum;
  }
  return sharing_peak(mean);
}

Peak highest(const Peak& a, const Peak& b) { return {std::max(a.sampled, b.sampled), std::max(a.refined, b.refined)}; }

/// The meshes of one kind in a window, with both sides of jumps.
struct KindWindow {
  const ResponseWindow& window;
  Eigen::Index first, planets;

  [[nodiscard]] auto force() const { return window.force.middleRows(first, planets); }
  [[nodiscard]] bool jumps() const { return window.jumps(); }
  /// Curves for the search of peaks, and their jumps.
  [[nodiscard]] auto curves() const {
    return (window.dense_force.size() > 0 ? window.dense_force : window.force).middleRows(first, planets);
  }
  [[nodiscard]] const auto& breaks() const {
    return window.dense_force.size() > 0 ? window.dense_after_jump : window.after_jump;
  }
  /// Both sides of all jumps.
  [[nodiscard]] Eigen::MatrixXd at_jumps() const {
    Eigen::MatrixXd forces(planets, 2 * window.jump_time.size());
    forces << window.force_before.middleRows(first, planets), window.force_after.middleRows(first, planets);
    return forces;
  }
  [[nodiscard]] Peak averaged() const {
    if (!jumps()) return averaged_peak(force(), window.samples_per_cycle);
    return averaged_peak(averaging_force(window).middleRows(first, planets), window.samples_per_cycle);
  }
  /// From every second sample: behind jumps the trapezoidal rule is no longer exact to rounding.
  [[nodiscard]] Peak averaged_coarsely() const {
    if (!jumps() || window.samples_per_cycle % 2 != 0) return averaged();
    const Eigen::Index samples = window.force.cols() / 2;
    ResponseWindow coarse;
    coarse.samples_per_cycle = window.samples_per_cycle / 2;
    coarse.time = window.time(Eigen::seqN(0, samples, 2));
    coarse.force = window.force(Eigen::all, Eigen::seqN(0, samples, 2));
    coarse.jump_time = window.jump_time;
    coarse.force_before = window.force_before;
    coarse.force_after = window.force_after;
    return KindWindow{coarse, first, planets}.averaged();
  }
  [[nodiscard]] double mean_force(Eigen::Index branch) const {
    return (jumps() ? averaging_force(window) : window.force).row(first + branch).mean();
  }

  [[nodiscard]] Peak sharing() const {
    if (!jumps()) return sharing_peak(curves());
    const double sampled = std::max(load_sharing_instantaneous(curves()), load_sharing_instantaneous(at_jumps()));
    if (!std::isfinite(sampled)) return {sampled, sampled};
    return highest({sampled, sampled}, peak_of_rows(load_sharing_over_time(curves()), breaks()));
  }
  [[nodiscard]] Peak largest_force(Eigen::Index branch) const {
    const Peak smooth = peak_of(curves().row(branch), breaks());
    if (!jumps()) return smooth;
    const double jump = at_jumps().row(branch).maxCoeff();
    return highest({jump, jump}, smooth);
  }
  [[nodiscard]] double least_force(Eigen::Index branch) const {
    const double sampled = curves().row(branch).minCoeff();
    return jumps() ? std::min(sampled, at_jumps().row(branch).minCoeff()) : sampled;
  }
};

Peak operator/(const Peak& peak, double scale) { return {peak.sampled / scale, peak.refined / scale}; }

enum class CurveKind { smooth, with_jumps };

/// Without inertia the forces follow every jump at once, so no parabola fits between the positions.
Peak quasi_static_peak(const Eigen::MatrixXd& force, CurveKind kind) {
  if (kind == CurveKind::smooth) return sharing_peak(force);
  const double sampled = load_sharing_instantaneous(force);
  return {sampled, sampled};
}

}  // namespace

MeshKindResult evaluate_meshes(const ResponseEvidence& evidence, Eigen::Index first, Eigen::Index planets,
                               const Eigen::MatrixXd& quasi_static_force) {
  const KindWindow best{evidence.best, first, planets}, before{evidence.before, first, planets},
      loose{evidence.loose, first, planets};
  MeshKindResult result;
  auto& sharing = result.load_sharing;
  sharing.instantaneous = figure(best.sharing(), {before.sharing(), loose.sharing()});
  sharing.averaged = figure(best.averaged(), {before.averaged(), loose.averaged(), best.averaged_coarsely()});
  sharing.quasi_static =
      figure(quasi_static_peak(quasi_static_force, best.jumps() ? CurveKind::with_jumps : CurveKind::smooth), {});
  for (Eigen::Index p = 0; p < planets; ++p) {
    const double f = evidence.mean_force;
    BranchResult branch;
    branch.dynamic_factor_max =
        figure(best.largest_force(p) / f, {before.largest_force(p) / f, loose.largest_force(p) / f});
    branch.dynamic_factor_min = best.least_force(p) / f;
    branch.mean_force = best.mean_force(p);
    branch.contact_loss = evidence.best.open[first + p];
    result.branches.push_back(branch);
  }
  return result;
}

double force_balance(const PlanetaryStage& stage, const LumpedSystem& system, const ResponseWindow& window,
                     const SystemState& begin, const SystemState& end, int cycles) {
  const int u = system.find("sun_u");
  const double duration = cycles / stage.mesh_frequency();
  const double forces = averaging_force(window).topRows(stage.planets()).colwise().sum().mean();
  const double support = system.stiffness()(u, u) * window.displacement.row(u).mean() +
                         system.damping()(u, u) * (end.q[u] - begin.q[u]) / duration;
  const double inertia = system.mass()(u, u) * (end.v[u] - begin.v[u]) / duration;
  return std::abs((forces + support + inertia) / system.load()[u] - 1);
}

}  // namespace annulus::dynamics
