#pragma once

#include <Eigen/Core>
#include <string>

#include "dynamics/systems/planetary/bearing_forces.h"
#include "dynamics/systems/planetary/poincare.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::dynamics {

/// Path of the centre of a central body, m, one value per time.
struct Orbit {
  Eigen::VectorXd x, y;                  ///< in the frame of the carrier
  Eigen::VectorXd housing_x, housing_y;  ///< in the housing; the frames coincide at time 0
};
/// `body`: "sun", "ring" or "carrier". The orbit is zero when its support is rigid.
[[nodiscard]] Orbit orbit(const PlanetaryStage& stage, const TimeSeries& series, const std::string& body = "sun");

/// What bearings, supports and the sun do over the evaluated window.
struct StageMotion {
  StageForces forces;
  Orbit sun_orbit;
  PoincareSection section;
  SectionPattern pattern;  ///< period_1 too where the section is one error period that the window before confirms
};
/// `response` with its time series.
[[nodiscard]] StageMotion stage_motion(const PlanetaryStage& stage, const DynamicResponse& response);

}  // namespace annulus::dynamics
