#include "dynamics/systems/planetary/stage_motion.h"

#include <algorithm>
#include <cmath>

namespace annulus::dynamics {

Orbit orbit(const PlanetaryStage& stage, const TimeSeries& series, const std::string& body) {
  const auto coordinate = [&](const std::string& dof) -> Eigen::VectorXd {
    const auto found = std::find(series.dofs.begin(), series.dofs.end(), dof);
    if (found == series.dofs.end()) return Eigen::VectorXd::Zero(series.time.size());
    return series.displacement.row(found - series.dofs.begin()).transpose();
  };
  Orbit result;
  result.x = coordinate(body + "_x");
  result.y = coordinate(body + "_y");
  const Eigen::ArrayXd angle = stage.carrier_speed * series.time.array();
  result.housing_x = (angle.cos() * result.x.array() - angle.sin() * result.y.array()).matrix();
  result.housing_y = (angle.sin() * result.x.array() + angle.cos() * result.y.array()).matrix();
  return result;
}

namespace {

/// Points of a steady window differ from the periodic motion by as much as the window does from what confirmed it, in
/// forces and in the deflections under them. A difference of two points contains that twice.
SectionAccuracy section_accuracy(const PlanetaryStage& stage, const DynamicResponse& response) {
  if (!response.steady || !response.steady_difference) return {};
  const double force = 2 * *response.steady_difference * response.mean_mesh_force;
  return {force, force / mean_stiffness(stage.sun_mesh)};
}

}  // namespace

StageMotion stage_motion(const PlanetaryStage& stage, const DynamicResponse& response) {
  const auto& series = response.series;
  const auto samples_per_cycle = static_cast<int>(series.time.size() / response.window_cycles);
  StageMotion motion{stage_forces(stage, assemble(stage), series),
                     orbit(stage, series),
                     poincare_section(stage, series, samples_per_cycle),
                     {}};
  motion.pattern = section_pattern(motion.section, stage.error_period(), section_accuracy(stage, response));
  // One error period alone does not show whether it repeats; the comparison with the window before does.
  if (motion.pattern.kind == SectionKind::undecided && response.steady && response.whole_period) {
    motion.pattern.kind = SectionKind::period_1;
    motion.pattern.period = response.window_cycles;
  }
  return motion;
}

}  // namespace annulus::dynamics
