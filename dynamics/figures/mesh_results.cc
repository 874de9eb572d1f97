#include "dynamics/figures/mesh_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "dynamics/figures/peaks.h"

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

/// Some meshes of a window, with both sides of jumps.
struct MeshWindow {
  const ResponseWindow& window;
  Eigen::Index first, count;

  [[nodiscard]] auto force() const { return window.force.middleRows(first, count); }
  [[nodiscard]] bool jumps() const { return window.jumps(); }
  /// Curves for the search of peaks, and their jumps.
  [[nodiscard]] auto curves() const {
    return (window.dense_force.size() > 0 ? window.dense_force : window.force).middleRows(first, count);
  }
  [[nodiscard]] const auto& breaks() const {
    return window.dense_force.size() > 0 ? window.dense_after_jump : window.after_jump;
  }
  /// Both sides of all jumps.
  [[nodiscard]] Eigen::MatrixXd at_jumps() const {
    Eigen::MatrixXd forces(count, 2 * window.jump_time.size());
    forces << window.force_before.middleRows(first, count), window.force_after.middleRows(first, count);
    return forces;
  }
  [[nodiscard]] Peak averaged() const {
    if (!jumps()) return averaged_peak(force(), window.samples_per_cycle);
    return averaged_peak(averaging_force(window).middleRows(first, count), window.samples_per_cycle);
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
    return MeshWindow{coarse, first, count}.averaged();
  }
  [[nodiscard]] double mean_force(Eigen::Index branch) const {
    return (jumps() ? averaging_force(window) : window.force).row(first + branch).mean();
  }

  [[nodiscard]] Peak sharing() const {
    if (!jumps()) return sharing_peak(curves());
    const double sampled = std::max(load_sharing_instantaneous(curves()), load_sharing_instantaneous(at_jumps()));
    if (!std::isfinite(sampled)) return {sampled, sampled};
    return higher({sampled, sampled}, peak_of_rows(load_sharing_over_time(curves()), breaks()));
  }
  [[nodiscard]] Peak largest_force(Eigen::Index branch) const {
    const Peak smooth = peak_of(curves().row(branch), breaks());
    if (!jumps()) return smooth;
    const double jump = at_jumps().row(branch).maxCoeff();
    return higher({jump, jump}, smooth);
  }
  [[nodiscard]] double least_force(Eigen::Index branch) const {
    const double sampled = curves().row(branch).minCoeff();
    return jumps() ? std::min(sampled, at_jumps().row(branch).minCoeff()) : sampled;
  }
};

enum class CurveKind { smooth, with_jumps };

/// Without inertia the forces follow every jump at once, so no parabola fits between the positions.
Peak quasi_static_peak(const Eigen::MatrixXd& force, CurveKind kind) {
  if (kind == CurveKind::smooth) return sharing_peak(force);
  const double sampled = load_sharing_instantaneous(force);
  return {sampled, sampled};
}

/// The same meshes in the best window, and in others whose results should be equal: their differences are errors.
struct MeshEvidence {
  MeshWindow best, before, loose;
  MeshEvidence(const SteadyResponse& found, Eigen::Index first, Eigen::Index count)
      : best{found.best, first, count},
        before{found.before ? *found.before : found.best, first, count},
        loose{found.loose ? *found.loose : found.best, first, count} {}
};

}  // namespace

std::vector<BranchResult> branch_results(const SteadyResponse& found, Eigen::Index first, Eigen::Index count,
                                         double mean_force) {
  const MeshEvidence meshes(found, first, count);
  std::vector<BranchResult> results;
  for (Eigen::Index p = 0; p < count; ++p)
    results.push_back({figure(meshes.best.largest_force(p) / mean_force, {meshes.before.largest_force(p) / mean_force,
                                                                          meshes.loose.largest_force(p) / mean_force}),
                       meshes.best.least_force(p) / mean_force, meshes.best.mean_force(p), found.best.open[first + p]});
  return results;
}

LoadSharing load_sharing(const SteadyResponse& found, Eigen::Index first, Eigen::Index count,
                         const Eigen::MatrixXd& quasi_static_force) {
  const MeshEvidence meshes(found, first, count);
  const auto &best = meshes.best, &before = meshes.before, &loose = meshes.loose;
  return {figure(best.sharing(), {before.sharing(), loose.sharing()}),
          figure(best.averaged(), {before.averaged(), loose.averaged(), best.averaged_coarsely()}),
          figure(quasi_static_peak(quasi_static_force, best.jumps() ? CurveKind::with_jumps : CurveKind::smooth), {})};
}

Figure largest_dynamic_factor(const std::vector<BranchResult>& branches) {
  Figure largest{-1, not_known};
  for (const auto& b : branches)
    if (b.dynamic_factor_max.value > largest.value) largest = b.dynamic_factor_max;
  return largest;
}

double largest_contact_loss(const std::vector<BranchResult>& branches) {
  double largest = 0;
  for (const auto& b : branches) largest = std::max(largest, b.contact_loss);
  return largest;
}

double load_sharing_instantaneous(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  require(force.size() > 0, fmt::format("load sharing of {} branches at {} times", force.rows(), force.cols()));
  double largest = 0;
  for (const auto column : force.colwise()) {
    const double sum = column.sum();
    largest = std::max(largest, sum > 0 ? static_cast<double>(force.rows()) * column.maxCoeff() / sum
                                        : std::numeric_limits<double>::infinity());
  }
  return largest;
}

Eigen::MatrixXd load_sharing_over_time(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  Eigen::MatrixXd share = force * static_cast<double>(force.rows());
  for (Eigen::Index i = 0; i < force.cols(); ++i) share.col(i) /= force.col(i).sum();
  return share;
}

}  // namespace annulus::dynamics
