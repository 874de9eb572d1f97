#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/planetary.h"

/// How gears stand so that their teeth mesh: the polar angle of each gear's tooth 0, counter-clockwise from the x axis.
namespace annulus::geometry {

/// The wheel's axis at the origin, the pinion's at the centre distance on the x axis, at mesh phase 0: in the pitch
/// point the driving flanks of PlanetarySet touch, the sun's leading with the planet's leading flank, the planet's
/// trailing with the ring's leading flank.
struct PairPlaces {
  double pinion = 0, wheel = 0;  ///< rad
};
[[nodiscard]] PairPlaces pair_places(const GearPair& pair);

/// A planet that stands at the polar angle `phi` of its sun, `lag` mesh cycles behind one at the angle 0: the planet
/// turns clockwise while the sun drives counter-clockwise.
[[nodiscard]] double planet_place(const GearPair& sun_mesh, double phi, double lag);

/// A stage at time 0 in the frame of its carrier, the sun's axis at the origin: sun and planet 0 touch in their pitch
/// point.
struct StagePlaces {
  double sun = 0, ring = 0;       ///< rad
  std::vector<double> planets{};  ///< rad, about their own axes
};
[[nodiscard]] StagePlaces stage_places(const PlanetarySet& set);

/// Where the line of action touches the pinion's base circle, and its direction from there, in the frame of
/// pair_places: contact at the pinion's roll length rho lies at tangent + rho along.
struct ActionLine {
  Eigen::Vector2d tangent = Eigen::Vector2d::Zero();  ///< m
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();   ///< unit vector
};
[[nodiscard]] ActionLine action_line(const GearPair& pair);

}  // namespace annulus::geometry
