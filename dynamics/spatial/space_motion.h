#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/spatial/space_bodies.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::dynamics {

/// What bearings and meshes of a system in space do over time.
struct SpaceMotion {
  struct Bearing {
    std::string name;  ///< LinearBearing::element()
    StageBody body, on;
    /// N, N m: x, y, z, about x, about y in the axes of the body, on the body, x times; without its dampers. Not known
    /// in rigid coordinates.
    Eigen::MatrixXd force;
    /// Of a bearing with its tangents: the largest difference of force, and moment over half the face width, to its
    /// whole law (or that of its coupling), over the mean mesh force.
    double law_deviation = 0;
    double table_end = 0;  ///< N, radial, at which its table ends; 0: it has none
  };
  static constexpr double light = 0.05;  ///< of the mean force: where a mesh carries less, its place says nothing
  struct Mesh {
    std::string name;
    double face_width = 0;    ///< m
    bool solid_face = false;  ///< of solid gears (SpreadFace::shape)
    double mean_place = 0;    ///< m, of the mean force and moment
    Eigen::VectorXd cycles;   ///< mesh cycles at which the excitation is read
    Eigen::VectorXd force;    ///< N, of the mesh
    Eigen::VectorXd tilt;     ///< m, by which the end of the face approaches further than its middle
    /// m, z of the resultant from the middle of the common face; not known of light forces.
    Eigen::VectorXd place;
  };
  std::vector<Bearing> bearings;     ///< those that give way
  Eigen::VectorXd turning_torque{};  ///< N m, on the body that a coupling turns (LinearCoupling::turned)
  std::vector<Mesh> meshes;          ///< in their order
};

/// The system that a series belongs to.
struct SpaceSystem {
  std::vector<std::vector<LinearForm>> bearings{};  ///< coordinates of each in its place
  LinearForm turned{};                              ///< the coordinate of LinearCoupling::turned
  double turned_radius = 0;                         ///< m, of that body
  double carrier_speed = 0;                         ///< rad/s
  std::vector<const SpreadFace*> faces{};           ///< of each mesh
};
/// `lumped`: with the DOFs of the series. Its meshes, and the forces of the series, are those of the faces, then those
/// of their tilts (spread_over_face()), then others.
[[nodiscard]] SpaceMotion motion_in_space(const SpaceSupports& supports, const SpaceSystem& system,
                                          const LumpedSystem& lumped, const TimeSeries& series);

}  // namespace annulus::dynamics
