#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "core/units.h"
#include "dynamics/spatial/carrier_structure.h"
#include "dynamics/spatial/even_face.h"
#include "dynamics/systems/planetary/spatial_stage.h"

/// Stages in space that tests share.
namespace annulus::dynamics::stages {

/// A mesh of constant stiffness (N/m, along the normal) spread over a face (m), with a gap per station.
inline StageFace even_face(double stiffness, double width, std::vector<double> gap = {}, int segments = 1) {
  StageFace face;
  std::vector<double> stations;
  for (int i = 0; i <= segments; ++i) stations.push_back(width * (static_cast<double>(i) / segments - 0.5));
  if (gap.empty()) gap.assign(stations.size(), 0.0);
  face.symmetric = gap == std::vector<double>(gap.rbegin(), gap.rend());
  face.law = [stiffness, stations, gap](double, StageFace::Flank) {
    return std::make_shared<EvenFace>(stiffness, stations, gap);
  };
  return face;
}

/// With stiffnesses in N/m and N m/rad; planets' in their own frame.
inline StageBearing bearing(const std::string& name, StageBody body, StageBody on, double place, double radial,
                            double axial = 0, double tilt = 0) {
  StageBearing b;
  b.name = name;
  b.body = body;
  b.on = on;
  b.place = place;
  b.x = b.y = radial;
  b.axial = axial;
  b.tilt = tilt;
  return b;
}

/// The ring in mounts beside its axis alone, evenly around it; the first one lies on x.
constexpr double mounts_radius = 0.6, mounts_place = 0.05, mounts_radial = 4e8, mounts_axial = 3e8;
inline void put_ring_in_mounts(SpatialStage& stage, int count) {
  stage.plane.ring.torsional_support = 0;
  std::erase_if(stage.bearings, [](const auto& b) { return b.body.kind == StageBody::Kind::ring; });
  for (int i = 0; i < count; ++i) {
    auto b = bearing("mount " + std::to_string(i + 1), {StageBody::Kind::ring}, {}, mounts_place, mounts_radial,
                     mounts_axial);
    const double angle = 2 * std::numbers::pi * i / count;
    b.beside = mounts_radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    stage.bearings.push_back(b);
  }
}

/// A row of rollers of a planet, with clearance.
inline RollingRow row_of_planets() {
  return {.count = 18, .diameter = 0.03, .length = 0.05, .clearance = 40e-6, .ring = RollingRow::Ring::outer};
}

/// SpatialStage::pins of pins that do not act on each other.
inline Eigen::MatrixXd on_each_planet(const SpatialStage& stage, const Eigen::Matrix<double, 5, 5>& pin) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(5 * stage.planets(), 5 * stage.planets());
  for (Eigen::Index first = 0; first < all.rows(); first += 5) all.block<5, 5>(first, first) = pin;
  return all;
}

/// A carrier of two walls 0.3 m apart, with a web between any two planets.
inline TwoWallCarrier two_wall_carrier(const SpatialStage& stage) {
  TwoWallCarrier carrier;
  carrier.planet_angles = stage.plane.planet_angles;
  carrier.radius = stage.plane.carrier.radius;
  carrier.pin = circular_beam(0.12, 206e9, 0.3);
  carrier.pin_length = 0.28;
  carrier.webs = stage.planets();
  carrier.web_radius = 0.33;
  carrier.web_length = 0.3;
  carrier.first_web = std::numbers::pi / stage.planets();
  carrier.web_width = 0.16;
  carrier.web_depth = 0.1;
  carrier.youngs_modulus = 175e9;
  carrier.poisson_ratio = 0.28;
  return carrier;
}

/// After the stage of the Gearbox Reliability Collaborative: 21/39/99 teeth, normal module 10 mm, three planets, helix
/// angle (rad) of right-handed planets as given. Rigid bodies, a floating sun; stiffnesses are assumed.
inline SpatialStage reliability_stage(double helix) {
  SpatialStage s;
  auto& p = s.plane;
  p.sun_teeth = 21;
  p.planet_teeth = 39;
  p.ring_teeth = 99;
  const double normal_angle = 20 * units::deg, transverse_module = 10e-3 / std::cos(helix);
  const double base = std::cos(std::atan(std::tan(normal_angle) / std::cos(helix)));
  const double a = 0.308;
  p.sun.radius = transverse_module * 21 / 2 * base;
  p.planet.radius = transverse_module * 39 / 2 * base;
  p.ring.radius = transverse_module * 99 / 2 * base;
  p.carrier.radius = a;
  p.sun_working_angle = std::acos((p.sun.radius + p.planet.radius) / a);
  p.ring_working_angle = std::acos((p.ring.radius - p.planet.radius) / a);
  s.base_helix_angle = std::asin(std::sin(helix) * std::cos(normal_angle));
  s.planet_working_radius_sun = a * 39 / (21 + 39);
  s.planet_working_radius_ring = a * 39 / (99 - 39);
  p.sun.mass = 180;
  p.planet.mass = 110;
  p.ring.mass = 509;
  p.carrier.mass = 1500;
  p.sun.support = 0;
  p.ring.torsional_support = rigid;
  for (int n = 0; n < 3; ++n) p.planet_angles.push_back(2 * std::numbers::pi * n / 3);
  p.carrier_speed = 22.2 * units::rpm;
  p.sun_torque = 325e3 / (1 + 99.0 / 21);
  s.sun_face = even_face(3e9, 0.22);
  s.ring_face = even_face(4e9, 0.2275);
  return s;
}

}  // namespace annulus::dynamics::stages
