#include "dynamics/response_evaluation.h"

#include <algorithm>
#include <cmath>

#include "dynamics/figures.h"
#include "dynamics/peaks.h"

namespace annulus::dynamics {

namespace {

Peak sharing_peak(const Eigen::Ref<const Eigen::MatrixXd>& force) {
  const double sampled = load_sharing_instantaneous(force);
  if (!std::isfinite(sampled)) return {sampled, sampled};
  return peak_of_rows(load_sharing_over_time(force));
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

}  // namespace

MeshKindResult evaluate_meshes(const ResponseEvidence& evidence, Eigen::Index first, Eigen::Index planets,
                               const Eigen::MatrixXd& quasi_static_force) {
  const auto rows = [&](const ResponseWindow& w) { return w.force.middleRows(first, planets); };
  const auto best = rows(evidence.best), before = rows(evidence.before), loose = rows(evidence.loose);
  MeshKindResult result;
  auto& sharing = result.load_sharing;
  sharing.instantaneous = figure(sharing_peak(best), {sharing_peak(before), sharing_peak(loose)});
  sharing.averaged = figure(averaged_peak(best, evidence.best.samples_per_cycle),
                            {averaged_peak(before, evidence.before.samples_per_cycle),
                             averaged_peak(loose, evidence.loose.samples_per_cycle)});
  sharing.quasi_static = figure(sharing_peak(quasi_static_force), {});
  for (Eigen::Index p = 0; p < planets; ++p) {
    const double f = evidence.mean_force;
    BranchResult branch;
    branch.dynamic_factor_max =
        figure(peak_of(best.row(p) / f), {peak_of(before.row(p) / f), peak_of(loose.row(p) / f)});
    branch.dynamic_factor_min = evidence.best.force.row(first + p).minCoeff() / f;
    branch.mean_force = evidence.best.force.row(first + p).mean();
    branch.contact_loss = evidence.best.open[first + p];
    result.branches.push_back(branch);
  }
  return result;
}

double force_balance(const PlanetaryStage& stage, const LumpedSystem& system, const ResponseWindow& window,
                     const SystemState& begin, const SystemState& end, int cycles) {
  const int u = system.find("sun_u");
  const double duration = cycles / stage.mesh_frequency();
  const double forces = window.force.topRows(stage.planets()).colwise().sum().mean();
  const double support = system.stiffness()(u, u) * window.displacement.row(u).mean() +
                         system.damping()(u, u) * (end.q[u] - begin.q[u]) / duration;
  const double inertia = system.mass()(u, u) * (end.v[u] - begin.v[u]) / duration;
  return std::abs((forces + support + inertia) / system.load()[u] - 1);
}

}  // namespace annulus::dynamics
