#include "dynamics/figures/mesh_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/errors.h"
#include "dynamics/figures/peaks.h"

namespace annulus::dynamics {

namespace {

/// N |F_n| / sum |F| over time; 0 where no branch carries any.
Eigen::MatrixXd absolute_shares(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  const Eigen::MatrixXd share = load_sharing_over_time(force);
  return share.array().isNaN().select(0.0, share.cwiseAbs());
}

Peak sharing_peak(const Eigen::Ref<const Eigen::MatrixXd>& force, const std::vector<Eigen::Index>& breaks = {}) {
  const double sampled = load_sharing_instantaneous(force);
  if (std::isnan(sampled)) return {sampled, sampled};
  Peak peak = peak_of_rows(absolute_shares(force), breaks);
  // Where one branch after the other carries the whole load, parabolas overshoot the largest possible share.
  peak.refined = std::max(peak.sampled, std::min(peak.refined, static_cast<double>(force.rows())));
  return peak;
}

/// Forces averaged over the mesh cycle that begins at each sample.
Eigen::MatrixXd sliding_means(const Eigen::Ref<const Eigen::MatrixXd>& force, int samples_per_cycle) {
  Eigen::MatrixXd mean(force.rows(), force.cols() - samples_per_cycle + 1);
  // Sliding accumulates rounding of about columns x eps, far below any use.
  Eigen::VectorXd sum = force.leftCols(samples_per_cycle).rowwise().sum();
  mean.col(0) = sum;
  for (Eigen::Index i = 1; i < mean.cols(); ++i) {
    sum += force.col(i + samples_per_cycle - 1) - force.col(i - 1);
    mean.col(i) = sum;
  }
  return mean;
}

Peak averaged_peak(const Eigen::Ref<const Eigen::MatrixXd>& force, int samples_per_cycle) {
  return sharing_peak(sliding_means(force, samples_per_cycle));
}

/// The mean force of a mesh over the mesh cycle around any instant. At the ends of a window that does not repeat, over
/// its first and its last whole cycle.
class CycleMean {
 public:
  /// From every `step`-th of the samples, `width` of them to a mesh cycle.
  CycleMean(Eigen::RowVectorXd force, int width, bool repeats, int step)
      : before_((width - 1) / 2.0), step_(step), repeats_(repeats) {
    const Eigen::Index samples = force.size();
    if (repeats) {
      force.conservativeResize(samples + width - 1);
      force.tail(width - 1) = force.head(width - 1).eval();
    }
    mean_ = (sliding_means(force, width) / width).cwiseAbs();
  }
  /// `force` over it, at so many samples behind the beginning of the window; 0 where the mesh carries nothing.
  [[nodiscard]] double ratio(double force, double sample) const {
    const auto count = static_cast<double>(mean_.size());
    double at = sample / step_ - before_;
    at = repeats_ ? at - count * std::floor(at / count) : std::clamp(at, 0.0, count - 1);
    const auto i = std::min(static_cast<Eigen::Index>(at), mean_.size() - 1);
    const double share = at - static_cast<double>(i);
    const double mean = share > 0 ? (1 - share) * mean_(i) + share * mean_((i + 1) % mean_.size()) : mean_(i);
    return mean > 0 ? force / mean : 0;
  }

 private:
  Eigen::RowVectorXd mean_;
  double before_;  // steps from the first sample of a mean to its middle
  int step_;
  bool repeats_;
};

/// |F| over the mean force of the mesh cycle around each of `per_sample` instants to a sample.
Eigen::RowVectorXd cycle_factor(const CycleMean& mean, const Eigen::Ref<const Eigen::RowVectorXd>& force,
                                double per_sample) {
  Eigen::RowVectorXd factor = force.cwiseAbs();
  for (Eigen::Index i = 0; i < factor.size(); ++i)
    factor[i] = mean.ratio(factor[i], static_cast<double>(i) / per_sample);
  return factor;
}

/// Some meshes of a window, with both sides of jumps.
struct MeshWindow {
  const ResponseWindow& window;
  Eigen::Index first, count;
  bool repeats = false;                         ///< its end is followed by its beginning
  bool closer = window.dense_force.size() > 0;  ///< peaks from the forces at closer times

  [[nodiscard]] auto force() const { return window.force.middleRows(first, count); }
  [[nodiscard]] bool jumps() const { return window.jumps(); }
  /// Curves for the search of peaks, and their jumps.
  [[nodiscard]] auto curves() const { return (closer ? window.dense_force : window.force).middleRows(first, count); }
  [[nodiscard]] const auto& breaks() const { return closer ? window.dense_after_jump : window.after_jump; }
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
  /// From every second sample: behind jumps, and where forces vibrate faster than they are sampled, the trapezoidal
  /// rule is no longer exact to rounding.
  [[nodiscard]] Peak averaged_coarsely() const {
    if (window.samples_per_cycle % 2 != 0) return averaged();
    const ResponseWindow coarse = every_second_sample(first, count);
    return MeshWindow{coarse, 0, count}.averaged();
  }
  [[nodiscard]] ResponseWindow every_second_sample(Eigen::Index mesh, Eigen::Index meshes) const {
    const Eigen::Index samples = window.force.cols() / 2;
    ResponseWindow coarse = jumps_of(mesh, meshes);
    coarse.samples_per_cycle = window.samples_per_cycle / 2;
    if (window.time.size() > 0) coarse.time = window.time(Eigen::seqN(0, samples, 2));
    coarse.force = window.force(Eigen::seqN(mesh, meshes), Eigen::seqN(0, samples, 2));
    coarse.after_jump = every_second(window.after_jump, samples);
    return coarse;
  }
  /// The same samples, between which forces are known at half of the closer times.
  [[nodiscard]] ResponseWindow every_second_closer_time() const {
    const Eigen::Index times = window.dense_force.cols() / 2;
    ResponseWindow coarse = jumps_of(first, count);
    coarse.samples_per_cycle = window.samples_per_cycle;
    coarse.time = window.time;
    coarse.force = force();
    coarse.after_jump = window.after_jump;
    coarse.dense_force = window.dense_force(Eigen::seqN(first, count), Eigen::seqN(0, times, 2));
    coarse.dense_per_sample = window.dense_per_sample / 2;
    coarse.dense_after_jump = every_second(window.dense_after_jump, times);
    return coarse;
  }
  [[nodiscard]] ResponseWindow jumps_of(Eigen::Index mesh, Eigen::Index meshes) const {
    ResponseWindow jumping;
    jumping.jump_time = window.jump_time;
    if (!jumps()) return jumping;
    jumping.force_before = window.force_before.middleRows(mesh, meshes);
    jumping.force_after = window.force_after.middleRows(mesh, meshes);
    return jumping;
  }
  /// Places among every second of some samples, of which there are `count`.
  static std::vector<Eigen::Index> every_second(const std::vector<Eigen::Index>& places, Eigen::Index count) {
    std::vector<Eigen::Index> list;
    for (const Eigen::Index i : places)
      if (const Eigen::Index at = (i + 1) / 2; at < count && (list.empty() || list.back() != at)) list.push_back(at);
    return list;
  }
  [[nodiscard]] double mean_force(Eigen::Index branch) const {
    return (jumps() ? averaging_force(window) : window.force).row(first + branch).mean();
  }

  [[nodiscard]] Peak sharing() const {
    const Peak smooth = sharing_peak(curves(), breaks());
    if (!jumps()) return smooth;
    const double jump = load_sharing_instantaneous(at_jumps());
    if (std::isnan(jump)) return smooth;
    return std::isnan(smooth.sampled) ? Peak{jump, jump} : higher({jump, jump}, smooth);
  }
  /// On whichever flanks it acts.
  [[nodiscard]] Peak largest_force(Eigen::Index branch) const {
    const Peak smooth = peak_of(curves().row(branch).cwiseAbs(), breaks());
    if (!jumps()) return smooth;
    const double jump = at_jumps().row(branch).cwiseAbs().maxCoeff();
    return higher({jump, jump}, smooth);
  }
  /// |F| over the mean force of the mesh cycle of `width` samples around each sample.
  [[nodiscard]] Eigen::RowVectorXd cycle_factor(Eigen::Index branch, int width) const {
    return dynamics::cycle_factor(cycle_mean(branch, width), force().row(branch), 1);
  }
  /// With means from every `step`-th sample.
  [[nodiscard]] Peak largest_cycle_factor(Eigen::Index branch, int width, int step = 1) const {
    const CycleMean mean = cycle_mean(branch, width, step);
    const Peak smooth =
        peak_of(dynamics::cycle_factor(mean, curves().row(branch), closer ? window.dense_per_sample : 1), breaks());
    if (!jumps()) return smooth;
    const double spacing =
        (window.time[window.time.size() - 1] - window.time[0]) / static_cast<double>(window.time.size() - 1);
    double jump = 0;
    for (Eigen::Index j = 0; j < window.jump_time.size(); ++j) {
      const double sample = (window.jump_time[j] - window.time[0]) / spacing;
      for (const auto* side : {&window.force_before, &window.force_after})
        jump = std::max(jump, mean.ratio(std::abs((*side)(first + branch, j)), sample));
    }
    return higher({jump, jump}, smooth);
  }
  [[nodiscard]] CycleMean cycle_mean(Eigen::Index branch, int width, int step = 1) const {
    if (step > 1) {
      const ResponseWindow coarse = every_second_sample(first + branch, 1);
      return {averaging_force(coarse).row(0), width / step, repeats, step};
    }
    return {(jumps() ? averaging_force(window) : window.force).row(first + branch), width, repeats, step};
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

Figure with_error(Figure figure, double error) {
  figure.error += error;
  return figure;
}

/// By how much the highest share of all columns is above those beside it, the lower one of both.
double drop_beside_peak(const Eigen::MatrixXd& force) {
  const Eigen::MatrixXd share = absolute_shares(force);
  Eigen::Index row = 0, column = 0;
  const double top = share.maxCoeff(&row, &column);
  double drop = 0;
  for (const Eigen::Index beside : {column - 1, column + 1})
    if (beside >= 0 && beside < share.cols()) drop = std::max(drop, top - share(row, beside));
  return drop;
}

Figure quasi_static_sharing(const Eigen::MatrixXd& force, const std::vector<Eigen::MatrixXd>& closer, CurveKind kind) {
  if (closer.empty()) return figure(quasi_static_peak(force, kind), {});
  Figure best{-1, 0};
  for (const auto& around : closer) {
    // A kink between two positions lies higher than these by half of that at most, where it is symmetric.
    const double kink = kind == CurveKind::smooth ? drop_beside_peak(around) / 2 : 0;
    const Figure here = with_error(figure(quasi_static_peak(around, kind), {}), kink);
    if (here.value > best.value) best = here;
  }
  return best;
}

/// The same meshes in the best window, and in others whose results should be equal: their differences are errors.
struct MeshEvidence {
  MeshWindow best, before, loose;
  /// `best` from every second of its samples, or of its closer times: behind jumps forces may vibrate faster.
  std::optional<ResponseWindow> half{};
  MeshEvidence(const SteadyResponse& found, Eigen::Index first, Eigen::Index count)
      : best{found.best, first, count, found.steady && found.whole_period},
        before{found.before ? *found.before : found.best, first, count, best.repeats},
        loose{found.loose ? *found.loose : found.best, first, count, best.repeats},
        alone(found.total_cycles == 0 && found.before),
        beside(best) {
    if (best.jumps() && best.closer && found.best.dense_per_sample % 2 == 0)
      half = best.every_second_closer_time();
    else if (best.jumps() && !best.closer && found.best.samples_per_cycle % 2 == 0)
      half = best.every_second_sample(first, count);
    // Peaks are compared as they are sampled in both; both sides of jumps are in any window.
    if (best.closer != before.closer && !best.jumps()) beside.closer = before.closer = false;
  }

  /// A harmonic balance without time integration. Its peaks at two samplings may agree by chance, so what counts is the
  /// largest difference at any instant.
  bool alone;
  MeshWindow beside;  ///< `best`, to compare with `before`

  /// What a result of all samples differs by from that of half of them, where these are all there is.
  template <class Result>
  [[nodiscard]] double sampling(const Peak& of_all, const Result& result) const {
    return half ? std::abs(of_all.refined - result(MeshWindow{*half, 0, best.count, best.repeats}).refined) : 0;
  }

  /// |difference| at the instants of `before`, largest over rows and instants, of matrices of as many columns as there
  /// are samples, or fewer.
  [[nodiscard]] double apart(const Eigen::MatrixXd& of_best, const Eigen::MatrixXd& of_before) const {
    const Eigen::Index step = best.window.samples_per_cycle / before.window.samples_per_cycle;
    return (of_best(Eigen::all, Eigen::seqN(0, of_before.cols(), step)) - of_before).cwiseAbs().maxCoeff();
  }
  [[nodiscard]] double forces_apart(Eigen::Index branch) const {
    return apart(best.force().row(branch), before.force().row(branch));
  }
  [[nodiscard]] double shares_apart() const {
    return apart(absolute_shares(best.force()), absolute_shares(before.force()));
  }
  [[nodiscard]] double averages_apart() const {
    const auto means = [](const MeshWindow& w) { return sliding_means(w.force(), w.window.samples_per_cycle); };
    return apart(absolute_shares(means(best)), absolute_shares(means(before)));
  }
  [[nodiscard]] Figure dynamic_factor(Eigen::Index branch, double mesh_cycle) const {
    const auto width = [&](const MeshWindow& w) {
      return std::clamp(static_cast<int>(std::lround(mesh_cycle * w.window.samples_per_cycle)), 1,
                        static_cast<int>(w.window.force.cols()));
    };
    const auto factor = [&](const MeshWindow& w) { return w.largest_cycle_factor(branch, width(w)); };
    const Peak largest = factor(best);
    if (!(largest.refined > 0)) return {not_known, not_known};
    const double other = alone
                             ? apart(best.cycle_factor(branch, width(best)), before.cycle_factor(branch, width(before)))
                             : std::abs(factor(beside).refined - factor(before).refined);
    // Loads that vary over more than a cycle are averaged by samples, too.
    const bool even = width(best) % 2 == 0 && best.window.force.cols() % 2 == 0;
    const Peak coarsely = even ? best.largest_cycle_factor(branch, width(best), 2) : largest;
    return with_error(figure(largest, {factor(loose), coarsely}), other + sampling(largest, factor));
  }
  /// By another motion, and by the samples at which contact is seen to begin and end.
  [[nodiscard]] Figure contact_loss(Eigen::Index branch) const {
    const auto open = [&](const MeshWindow& w) {
      return w.window.open.size() > 0 ? w.window.open[w.first + branch] : 0.0;
    };
    const double lost = open(best);
    Figure loss{lost, std::abs(lost - open(loose))};
    if (before.window.open.size() > 0) loss.error += std::abs(lost - open(before));
    if (lost > 0) loss.error += 0.5 / (best.window.dense_per_sample * best.window.samples_per_cycle);
    return loss;
  }
};

}  // namespace

std::vector<BranchResult> branch_results(const SteadyResponse& found, Eigen::Index first, Eigen::Index count,
                                         double nominal_force, double mesh_cycle) {
  const MeshEvidence meshes(found, first, count);
  std::vector<BranchResult> results;
  for (Eigen::Index p = 0; p < count; ++p) {
    const Peak largest = meshes.best.largest_force(p) / nominal_force;
    const double apart =
        meshes.alone ? meshes.forces_apart(p)
                     : std::abs(meshes.beside.largest_force(p).refined - meshes.before.largest_force(p).refined);
    const double sampling =
        meshes.sampling(largest, [&](const MeshWindow& w) { return w.largest_force(p) / nominal_force; });
    const auto factor =
        with_error(figure(largest, {meshes.loose.largest_force(p) / nominal_force}), apart / nominal_force + sampling);
    results.push_back({factor, meshes.dynamic_factor(p, mesh_cycle), meshes.best.least_force(p) / nominal_force,
                       meshes.best.mean_force(p), meshes.contact_loss(p),
                       found.best.back.size() > 0 ? found.best.back[first + p] : 0});
  }
  return results;
}

LoadSharing load_sharing(const SteadyResponse& found, Eigen::Index first, Eigen::Index count,
                         const Eigen::MatrixXd& quasi_static_force, const std::vector<Eigen::MatrixXd>& closer) {
  const MeshEvidence meshes(found, first, count);
  const auto &best = meshes.best, &before = meshes.before, &loose = meshes.loose;
  const auto quasi_static =
      quasi_static_sharing(quasi_static_force, closer, best.jumps() ? CurveKind::with_jumps : CurveKind::smooth);
  if (meshes.alone)
    return {with_error(figure(best.sharing(), {}), meshes.shares_apart()),
            with_error(figure(best.averaged(), {}), meshes.averages_apart()), quasi_static};
  return {with_error(figure(best.sharing(), {loose.sharing()}),
                     std::abs(meshes.beside.sharing().refined - before.sharing().refined) +
                         meshes.sampling(best.sharing(), [](const MeshWindow& w) { return w.sharing(); })),
          figure(best.averaged(), {before.averaged(), loose.averaged(), best.averaged_coarsely()}), quasi_static};
}

std::vector<Eigen::Index> highest_shares(const Eigen::MatrixXd& force, std::size_t most) {
  if (force.size() == 0 || std::isnan(load_sharing_instantaneous(force))) return {};
  const Eigen::RowVectorXd largest = absolute_shares(force).colwise().maxCoeff();
  const Eigen::Index n = largest.size();
  std::vector<Eigen::Index> tops;
  for (Eigen::Index i = 0; i < n; ++i)
    if (largest[i] >= largest[(i + n - 1) % n] && largest[i] >= largest[(i + 1) % n]) tops.push_back(i);
  std::stable_sort(tops.begin(), tops.end(), [&](Eigen::Index a, Eigen::Index b) { return largest[a] > largest[b]; });
  tops.resize(std::min(tops.size(), most));
  return tops;
}

std::size_t worst_branch(const std::vector<BranchResult>& branches, Figure BranchResult::*result) {
  require(!branches.empty(), "the largest result of no branch");
  std::size_t worst = 0;
  for (std::size_t n = 1; n < branches.size(); ++n) {
    const double value = (branches[n].*result).value, largest = (branches[worst].*result).value;
    // Of equal values, as of times without contact that are zero, the less certain one.
    const bool less_certain = value == largest && (branches[n].*result).error > (branches[worst].*result).error;
    if (std::isnan(largest) || value > largest || less_certain) worst = n;
  }
  return worst;
}

Figure largest(const std::vector<BranchResult>& branches, Figure BranchResult::*result) {
  return branches[worst_branch(branches, result)].*result;
}

double load_sharing_instantaneous(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  require(force.size() > 0, fmt::format("load sharing of {} branches at {} times", force.rows(), force.cols()));
  double largest = 0;
  for (const auto column : force.colwise())
    if (const double sum = column.cwiseAbs().sum(); sum > 0)
      largest = std::max(largest, static_cast<double>(force.rows()) * column.cwiseAbs().maxCoeff() / sum);
  return largest > 0 ? largest : not_known;
}

Eigen::MatrixXd load_sharing_over_time(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  Eigen::MatrixXd share = force * static_cast<double>(force.rows());
  for (Eigen::Index i = 0; i < force.cols(); ++i) {
    const double sum = force.col(i).cwiseAbs().sum();
    if (sum > 0)
      share.col(i) /= sum;
    else
      share.col(i).setConstant(not_known);
  }
  return share;
}

}  // namespace annulus::dynamics
