#include "dynamics/systems/planetary/orbit.h"

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
  if (series.time.size() == 0) return result;
  result.mean_x = result.x.mean();
  result.mean_y = result.y.mean();
  result.extent =
      std::sqrt(((result.x.array() - result.mean_x).square() + (result.y.array() - result.mean_y).square()).maxCoeff());
  result.largest = std::sqrt((result.x.array().square() + result.y.array().square()).maxCoeff());
  return result;
}

}  // namespace annulus::dynamics
