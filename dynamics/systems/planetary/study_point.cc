#include "dynamics/systems/planetary/study_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "dynamics/system/lumped_system.h"
#include "dynamics/systems/planetary/planetary_modes.h"

namespace annulus::dynamics {

namespace {

KindFigures figures_of(const MeshKindResult& kind) {
  KindFigures f{kind.load_sharing.instantaneous.value, kind.load_sharing.averaged.value,
                kind.load_sharing.quasi_static.value};
  for (const auto& b : kind.branches) {
    f.dynamic_factor = std::max(f.dynamic_factor, b.dynamic_factor_max.value);
    f.contact_loss = std::max(f.contact_loss, b.contact_loss);
  }
  return f;
}

/// Samples per mesh cycle of figures that are compared, at most `wanted` where all is smooth. Jumps set off vibrations
/// of the highest modes, whose peaks need close samples in a time integration (measured: 32 samples err by 1 %).
int samples_of_point(const PlanetaryStage& stage, int wanted) {
  constexpr int after_jumps = 128;
  for (const auto* mesh : {&stage.sun_mesh, &stage.ring_mesh})
    if (std::holds_alternative<RectangularStiffness>(*mesh) && stage.error_period() <= long_window)
      return std::max(wanted, after_jumps);
  return std::min(wanted, enough_samples(stage.error_period()));
}

/// Decides how the response of a point is found: by harmonic balance without confirmation while no mesh loses contact.
/// With loss of contact several motions may exist, and time integration decides between them.
DynamicResponse response_of_point(const PlanetaryStage& stage, const PointOptions& options) {
  SimulationOptions simulation = options.simulation;
  simulation.estimate_error = false;  // the nominal run estimates the error; a study compares
  simulation.confirm = false;
  simulation.keep_series = options.motion;
  if (!options.motion && !simulation.mesh_cycles)
    simulation.samples_per_cycle = samples_of_point(stage, simulation.samples_per_cycle);
  auto response = simulate(stage, simulation);
  const bool opens =
      std::max(figures_of(response.sun_planet).contact_loss, figures_of(response.ring_planet).contact_loss) > 0;
  // A response that was integrated in time needs no second one.
  if (!opens || simulation.mesh_cycles || response.total_cycles > 0) return response;
  simulation.confirm = true;
  return simulate(stage, simulation);
}

MotionRange motion_of(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  return {std::sqrt((values.array() - values.mean()).square().mean()), values.maxCoeff() - values.minCoeff()};
}

MotionRange sun_motion(const LumpedSystem& system, const TimeSeries& series) {
  const int x = system.find("sun_x"), y = system.find("sun_y");
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (x < 0 || y < 0) return {unknown, unknown};
  const MotionRange a = motion_of(series.displacement.row(x)), b = motion_of(series.displacement.row(y));
  return {std::hypot(a.rms, b.rms), std::max(a.peak_to_peak, b.peak_to_peak)};
}

/// delta = b^T q - e(t), one row per mesh, one column per time.
Eigen::MatrixXd deflections(const LumpedSystem& system, const TimeSeries& series) {
  const auto meshes = static_cast<Eigen::Index>(system.meshes().size());
  Eigen::MatrixXd result(meshes, series.time.size());
  auto workspace = system.workspace();
  for (Eigen::Index i = 0; i < series.time.size(); ++i) {
    system.detect_contact(series.time[i], series.displacement.col(i).data(), workspace);
    result.col(i) = Eigen::Map<const Eigen::VectorXd>(workspace.delta.data(), meshes);
  }
  return result;
}

MotionRange largest_motion(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  MotionRange largest;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const MotionRange m = motion_of(rows.row(i));
    largest = {std::max(largest.rms, m.rms), std::max(largest.peak_to_peak, m.peak_to_peak)};
  }
  return largest;
}

std::vector<double> lowest_frequencies(const PlanetaryStage& stage, int count) {
  constexpr double same = 1e-6;  // modes in pairs agree to rounding, neighbours of different kind do not
  std::vector<double> list;
  for (const auto& mode : modes(stage).modes) {
    if (!(mode.frequency > 0) || (!list.empty() && mode.frequency <= list.back() * (1 + same))) continue;
    if (static_cast<int>(list.size()) == count) break;
    list.push_back(mode.frequency);
  }
  return list;
}

}  // namespace

PointFigures evaluate_point(const PlanetaryStage& stage, const PointOptions& options) {
  const auto response = response_of_point(stage, options);
  PointFigures figures{.sun_planet = figures_of(response.sun_planet),
                       .ring_planet = figures_of(response.ring_planet),
                       .steady = response.steady,
                       .window_cycles = response.window_cycles};
  if (!options.motion) return figures;
  const auto system = assemble(stage);
  const auto& series = response.series;
  const Eigen::MatrixXd delta = deflections(system, series);
  figures.sun = sun_motion(system, series);
  figures.sun_mesh = largest_motion(delta.topRows(stage.planets()));
  figures.ring_mesh = largest_motion(delta.bottomRows(stage.planets()));
  figures.frequencies = lowest_frequencies(stage, planetary_frequencies);
  const Eigen::Index per_cycle = series.time.size() / response.window_cycles;
  for (int c = 0; c < std::min(options.poincare_cycles, response.window_cycles); ++c)
    figures.poincare.push_back({series.force(0, c * per_cycle), delta(0, c * per_cycle)});
  return figures;
}

const char* point_method() { return "harmonic balance 3"; }

}  // namespace annulus::dynamics
