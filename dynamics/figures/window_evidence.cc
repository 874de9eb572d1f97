#include "dynamics/figures/window_evidence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace annulus::dynamics {

ResponseWindow samples_of(const ResponseWindow& window, int step) {
  const auto columns = Eigen::seqN(0, (window.time.size() + step - 1) / step, step);
  ResponseWindow samples;
  samples.samples_per_cycle = window.samples_per_cycle / step;
  samples.time = window.time(columns);
  for (const auto part : {&ResponseWindow::force, &ResponseWindow::displacement, &ResponseWindow::velocity})
    samples.*part = (window.*part)(Eigen::all, columns);
  return samples;
}

double force_difference(const SteadyResponse& found, Eigen::Index meshes) {
  double largest = 0;
  for (const auto* other : {&found.before, &found.loose}) {
    if (!*other || (*other)->displacement.size() > 0) continue;
    const auto& force = (*other)->force;
    const Eigen::Index stride = found.best.force.cols() / force.cols();
    const auto best = found.best.force(Eigen::seqN(0, meshes), Eigen::seqN(0, force.cols(), stride));
    largest = std::max(largest, (best - force.topRows(meshes)).cwiseAbs().maxCoeff());
  }
  return largest;
}

std::vector<ResponseWindow> compared_windows(const SteadyResponse& found) {
  std::vector<ResponseWindow> others;
  for (const auto* other : {&found.before, &found.loose})
    if (*other && (*other)->displacement.size() > 0) others.push_back(**other);
  if (found.best.jumps()) others.push_back(samples_of(found.best, 2));
  return others;
}

ResponseWindow closer_samples(const LumpedSystem& system, const ResponseWindow& window, int pieces) {
  const Eigen::Index samples = window.time.size(), times = (samples - 1) * pieces + 1;
  const int n = system.dofs();
  ResponseWindow closer;
  closer.samples_per_cycle = window.samples_per_cycle * pieces;
  closer.time.resize(times);
  closer.displacement.resize(n, times);
  closer.velocity.resize(n, times);
  closer.force.resize(window.force.rows(), times);
  auto workspace = system.workspace();
  Eigen::VectorXd state(2 * n), rate(2 * n);
  for (Eigen::Index i = 0; i < times; ++i) {
    const Eigen::Index from = std::min(i / pieces, samples - 2), to = from + 1;
    const double step = window.time[to] - window.time[from];
    const double s = static_cast<double>(i - from * pieces) / pieces, r = 1 - s;
    const auto q0 = window.displacement.col(from), q1 = window.displacement.col(to);
    const auto v0 = window.velocity.col(from), v1 = window.velocity.col(to);
    state.head(n) = r * r * (1 + 2 * s) * q0 + s * s * (1 + 2 * r) * q1 + step * r * s * (r * v0 - s * v1);
    state.tail(n) = 6 * r * s / step * (q1 - q0) + r * (r - 2 * s) * v0 + s * (s - 2 * r) * v1;
    closer.time[i] = window.time[from] + s * step;
    system.detect_contact(closer.time[i], state.data(), workspace);
    system.rhs(closer.time[i], state.data(), rate.data(), workspace);
    closer.displacement.col(i) = state.head(n);
    closer.velocity.col(i) = state.tail(n);
    closer.force.col(i) = Eigen::Map<const Eigen::VectorXd>(workspace.force.data(), closer.force.rows());
  }
  return closer;
}

FigureSet window_figures(const LumpedSystem& system, const SteadyResponse& found,
                         const std::function<WindowValues(const ResponseWindow&)>& values) {
  // Samples resolve the highest excited frequency by four (SimulationOptions); sixteen are near every peak.
  constexpr int pieces = 4;
  const auto sampled = values(found.best);
  const auto closer =
      found.best.jumps() && found.best.time.size() > 1 ? values(closer_samples(system, found.best, pieces)) : sampled;
  std::vector<WindowValues> others;
  for (const auto& window : compared_windows(found)) others.push_back(values(window));
  const double difference = force_difference(found, found.best.force.rows());
  FigureSet figures;
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    const auto& [key, value] = sampled[i];
    auto result = figure(value.of == ValueOf::one_instant ? closer[i].second.peak : value.peak, {value.peak});
    result.error += value.per_force * difference;
    for (const auto& other : others) result.error += std::abs(value.peak.refined - other[i].second.peak.refined);
    figures.set(key, result);
  }
  return figures;
}

}  // namespace annulus::dynamics
