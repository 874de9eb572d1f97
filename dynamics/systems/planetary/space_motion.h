#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/steady_state/steady_response.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// What bearings and meshes of a stage in space do over time.
struct SpaceMotion {
  struct Bearing {
    std::string name;  ///< LinearBearing::element()
    StageBody body, on;
    /// N, N m: x, y, z, about x, about y in the axes of the body, on the body, x times; without its dampers. Not known
    /// in rigid coordinates.
    Eigen::MatrixXd force;
  };
  static constexpr double light = 0.05;  ///< of the mean force: where a mesh carries less, its place says nothing
  struct Mesh {
    std::string name;
    double mean_place = 0;  ///< m, of the mean force and moment
    /// m, z of the resultant from the middle of the common face; not known of light forces.
    Eigen::VectorXd place;
  };
  std::vector<Bearing> bearings;  ///< those of StageSpace that give way
  Eigen::VectorXd ring_torque{};  ///< N m, of the housing on the ring, where LinearCoupling::turns_ring
  std::vector<Mesh> meshes;       ///< sun meshes, then ring meshes
};
/// Empty for a plane stage. `series` must belong to the stage.
[[nodiscard]] SpaceMotion space_motion(const PlanetaryStage& stage, const TimeSeries& series);

}  // namespace annulus::dynamics
