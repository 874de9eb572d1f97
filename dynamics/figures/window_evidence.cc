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

double force_between_samples(const ResponseWindow& window, Eigen::Index meshes) {
  double largest = 0;
  for (Eigen::Index m = 0; m < meshes; ++m) {
    const auto amount = [m](const Eigen::MatrixXd& force) -> Eigen::RowVectorXd { return force.row(m).cwiseAbs(); };
    const double sampled = peak_of(amount(window.force), window.after_jump).refined;
    double closer = sampled;
    if (window.dense_force.size() > 0) closer = peak_of(amount(window.dense_force), window.dense_after_jump).refined;
    for (const auto* side : {&window.force_before, &window.force_after})
      if (side->size() > 0) closer = std::max(closer, amount(*side).maxCoeff());
    largest = std::max(largest, std::abs(closer - sampled));
  }
  return largest;
}

std::vector<Figure> window_figures(const SteadyResponse& found, Eigen::Index meshes,
                                   const std::function<std::vector<WindowValue>(const ResponseWindow&)>& values) {
  const auto best = values(found.best);
  const double difference = force_difference(found, meshes), missed = force_between_samples(found.best, meshes);
  std::vector<Figure> figures;
  for (const auto& value : best) {
    figures.push_back(figure(value.peak, {}));
    figures.back().error += value.per_force * (difference + (value.of == ValueOf::one_instant ? missed : 0));
  }
  for (const auto& window : compared_windows(found)) {
    const auto other = values(window);
    for (std::size_t i = 0; i < best.size(); ++i)
      figures[i].error += std::abs(best[i].peak.refined - other[i].peak.refined);
  }
  return figures;
}

}  // namespace annulus::dynamics
