#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/spatial/stage_bearing.h"
#include "dynamics/spatial/stage_bodies.h"

/// What scenes of systems have whose bodies tilt; SI.
namespace annulus::app {

struct BearingInput {
  using Body = dynamics::StageBody::Kind;
  std::string name;
  Body body = Body::carrier;
  std::optional<int> planet;  ///< 1, 2, ...; absent: every planet
  std::optional<Body> on;     ///< absent: the housing, of planets the carrier
  double place = 0;
  std::vector<double> beside;  ///< two values, or none: on the axis
  std::optional<double> radial, x, y;
  double axial = 0, tilt = 0;
  double clearance = 0, axial_clearance = 0, tilt_clearance = 0;
  bool load_zone = true;
  std::vector<double> matrix;
  std::vector<double> displacement, force;
  std::optional<int> rollers, balls;
  std::optional<double> roller_length, roller_diameter, ball_diameter, pitch_diameter;
  double contact_angle = 0, inner_groove = 0.52, outer_groove = 0.53;
  std::optional<dynamics::RollingRow::Ring> ring;  ///< absent: planets have the outer one, other bodies the inner one

  [[nodiscard]] bool rolls() const { return rollers || balls; }
  /// Does it hold differently along x and y?
  [[nodiscard]] bool has_directions() const { return !matrix.empty() || along_x() != along_y(); }
  [[nodiscard]] double along_x() const { return x.value_or(radial.value_or(0)); }  ///< N/m
  [[nodiscard]] double along_y() const { return y.value_or(radial.value_or(0)); }
  [[nodiscard]] bool holds_radially() const {
    return radial || x || y || rolls() || !displacement.empty() || !matrix.empty();
  }
};

struct LoadInput {
  std::string name;
  dynamics::StageBody::Kind body = dynamics::StageBody::Kind::carrier;
  std::optional<int> planet;
  dynamics::StageFrame frame = dynamics::StageFrame::housing;
  std::vector<double> point, force, moment;  ///< three values, or none
};

[[nodiscard]] dynamics::RollingRow rolling_row(const BearingInput& bearing);
[[nodiscard]] dynamics::StageBearing stage_bearing(const BearingInput& input, const dynamics::StageBody& body,
                                                   std::string name);
[[nodiscard]] dynamics::StageLoad stage_load(const LoadInput& input, const dynamics::StageBody& body, std::string name);

struct GravityInput {
  double acceleration = 0, direction = 0, inclination = 0;
  /// m, z of the centres of mass.
  double sun = 0, planet = 0, ring = 0, carrier = 0, pinion = 0, wheel = 0;
  [[nodiscard]] Eigen::Vector3d vector() const;  ///< m/s^2, in the housing
};

/// The name of a bearing in columns and files.
[[nodiscard]] inline std::string column_of(std::string bearing) {
  std::replace(bearing.begin(), bearing.end(), ' ', '_');
  return bearing;
}

struct TiltInertiaInput {
  std::optional<double> sun, ring, carrier, planet, pinion, wheel;
};

/// Inputs of these systems (Scene::own).
struct SpaceInput {
  std::vector<BearingInput> bearings;
  std::vector<LoadInput> loads;
  std::optional<GravityInput> gravity;
  TiltInertiaInput tilt_inertia;
  dynamics::BearingLaws bearing_laws = dynamics::BearingLaws::tangents;

  [[nodiscard]] bool any() const { return !bearings.empty() || !loads.empty() || gravity; }
  [[nodiscard]] bool has_bearing(BearingInput::Body body) const;
  /// Whether mounts beside the axis keep the ring from turning.
  [[nodiscard]] bool ring_in_mounts() const;
  /// Whether a body, or each of the planets, has a bearing that holds it radially.
  [[nodiscard]] bool has_radial_bearing(BearingInput::Body body, int planets = 1) const;
};

}  // namespace annulus::app
