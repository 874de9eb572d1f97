#include "app/systems/planetary/stage_motion.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/radial_bearing.h"
#include "core/units.h"
#include "dynamics/figures/motion.h"
#include "dynamics/systems/planetary/space_motion.h"
#include "dynamics/systems/planetary/stage_motion.h"

namespace annulus::app {

namespace {

/// rad, of a bearing with play under the forces on its pin.
Eigen::VectorXd load_zones(const dynamics::PlanetBearing& bearing, const Eigen::VectorXd& force) {
  const RadialBearing law(bearing.radial, bearing.play, bearing.pin);
  return force.unaryExpr([&](double f) { return law.load_zone(f); });
}

Csv bearing_table(const dynamics::StageMotion& found, const dynamics::PlanetaryStage& stage, int cycles) {
  Csv csv;
  csv.columns = {"mesh_cycle"};
  for (int c = 0; c < cycles; ++c) csv.rows.emplace_back(1, c);
  const Eigen::MatrixXd resultant = found.forces.pins.resultant();
  for (Eigen::Index n = 0; n < resultant.rows(); ++n) {
    const auto name = "planet" + std::to_string(n + 1);
    const auto in_cycles = [&](const Eigen::MatrixXd& rows) {
      return dynamics::over_cycles(rows.row(n).transpose(), cycles);
    };
    csv.add_column(name + "_radial_mean_N", in_cycles(found.forces.pins.radial).mean);
    csv.add_column(name + "_tangential_mean_N", in_cycles(found.forces.pins.tangential).mean);
    csv.add_column(name + "_resultant_min_N", in_cycles(resultant).smallest);
    csv.add_column(name + "_resultant_max_N", in_cycles(resultant).largest);
    if (const auto bearing = stage.planet_bearing(static_cast<int>(n)); bearing.play > 0) {
      const auto zone = dynamics::over_cycles(load_zones(bearing, resultant.row(n).transpose()), cycles).smallest;
      csv.add_column(name + "_load_zone_min_deg", zone / units::deg);
    }
  }
  const auto support = [&](const char* name, const dynamics::SupportReaction& reaction) {
    csv.add_column(std::string(name) + "_support_max_N", dynamics::over_cycles(reaction.magnitude(), cycles).largest);
  };
  support("sun", found.forces.sun);
  support("ring", found.forces.ring);
  support("carrier", found.forces.carrier);
  if (!stage.held) return csv;
  using geometry::StageMember;
  const auto& reaction = *stage.held == StageMember::sun    ? found.forces.sun
                         : *stage.held == StageMember::ring ? found.forces.ring
                                                            : found.forces.carrier;
  csv.add_column("held_torque_mean_N_m", dynamics::over_cycles(reaction.torque, cycles).mean);
  return csv;
}

}  // namespace

StageMotion tabulated_motion(const dynamics::PlanetaryStage& stage, const dynamics::DynamicResponse& response) {
  const auto found = dynamics::stage_motion(stage, response);
  StageMotion motion;
  motion.bearing_forces = bearing_table(found, stage, response.window_cycles);
  motion.space = space_results(dynamics::space_motion(stage, response.series), response.window_cycles);
  const auto& path = found.sun_orbit;
  motion.sun_orbit.columns = {"mesh_cycle", "x_m", "y_m", "housing_x_m", "housing_y_m"};
  const auto samples_per_cycle = static_cast<double>(path.x.size()) / response.window_cycles;
  // Long orbits are drawn by 21 points per mesh cycle.
  const int stride = response.window_cycles > dynamics::long_window ? 3 : 1;
  for (Eigen::Index i = 0; i < path.x.size(); i += stride)
    motion.sun_orbit.rows.push_back(
        {static_cast<double>(i) / samples_per_cycle, path.x[i], path.y[i], path.housing_x[i], path.housing_y[i]});
  motion.section = dynamics::to_string(found.pattern.kind);
  motion.section_period = found.pattern.period;
  motion.section_clusters = found.pattern.clusters;
  motion.poincare.columns = {"mesh_cycle"};
  motion.poincare.columns.insert(motion.poincare.columns.end(), found.section.quantities.begin(),
                                 found.section.quantities.end());
  for (Eigen::Index c = 0; c < found.section.points.cols(); ++c) {
    auto& row = motion.poincare.rows.emplace_back(1, static_cast<double>(c));
    row.insert(row.end(), found.section.points.col(c).begin(), found.section.points.col(c).end());
  }
  return motion;
}

}  // namespace annulus::app
