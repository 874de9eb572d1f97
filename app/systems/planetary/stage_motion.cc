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

void add_bearings(StageMotion& motion, const dynamics::StageMotion& found, const dynamics::PlanetaryStage& stage,
                  int cycles) {
  auto& csv = motion.bearing_forces;
  csv.columns = {"mesh_cycle"};
  for (int c = 0; c < cycles; ++c) csv.rows.emplace_back(1, c);
  const Eigen::MatrixXd resultant = found.pins.resultant();
  for (Eigen::Index n = 0; n < resultant.rows(); ++n) {
    const auto name = "planet" + std::to_string(n + 1);
    const auto in_cycles = [&](const Eigen::MatrixXd& rows) {
      return dynamics::over_cycles(rows.row(n).transpose(), cycles);
    };
    csv.add_column(name + "_radial_mean_N", in_cycles(found.pins.radial).mean);
    csv.add_column(name + "_tangential_mean_N", in_cycles(found.pins.tangential).mean);
    csv.add_column(name + "_resultant_min_N", in_cycles(resultant).smallest);
    csv.add_column(name + "_resultant_max_N", in_cycles(resultant).largest);
    if (const auto bearing = stage.planet_bearing(static_cast<int>(n)); bearing.play > 0) {
      const auto zone = dynamics::over_cycles(load_zones(bearing, resultant.row(n).transpose()), cycles).smallest;
      csv.add_column(name + "_load_zone_min_deg", zone / units::deg);
      motion.load_zone_min =
          std::isnan(motion.load_zone_min) ? zone.minCoeff() : std::min(motion.load_zone_min, zone.minCoeff());
    }
    motion.pin_force_max.push_back(resultant.row(n).maxCoeff());
    motion.pin_force_mean_tangential.push_back(found.pins.tangential.row(n).mean());
  }
  const auto support = [&](const char* name, const dynamics::SupportReaction& reaction) {
    const Eigen::VectorXd magnitude = reaction.magnitude();
    csv.add_column(std::string(name) + "_support_max_N", dynamics::over_cycles(magnitude, cycles).largest);
    return magnitude.maxCoeff();
  };
  motion.sun_support_max = support("sun", found.sun_support);
  motion.ring_support_max = support("ring", found.ring_support);
  motion.carrier_support_max = support("carrier", found.carrier_support);
  if (!stage.held) return;
  using geometry::StageMember;
  const auto& reaction = *stage.held == StageMember::sun    ? found.sun_support
                         : *stage.held == StageMember::ring ? found.ring_support
                                                            : found.carrier_support;
  csv.add_column("held_torque_mean_N_m", dynamics::over_cycles(reaction.torque, cycles).mean);
  motion.held_torque_mean = reaction.torque.mean();
}

}  // namespace

StageMotion tabulated_motion(const dynamics::PlanetaryStage& stage, const dynamics::DynamicResponse& response) {
  const auto found = dynamics::stage_motion(stage, response);
  StageMotion motion;
  add_bearings(motion, found, stage, response.window_cycles);
  motion.space = space_results(dynamics::space_motion(stage, response.series), response.window_cycles);
  const auto& path = found.sun_orbit;
  motion.sun_orbit_extent = path.extent;
  motion.sun_orbit_largest = path.largest;
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
