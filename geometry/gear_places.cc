#include "geometry/gear_places.h"

#include <cmath>
#include <numbers>

namespace annulus::geometry {

namespace {

/// Half the angle of a tooth on the working pitch circle.
double half_tooth_at_pitch(const GearPair& pair, const Gear& gear) {
  return gear.tooth_half_angle(gear.base_radius() / std::cos(pair.working_pressure_angle()));
}

}  // namespace

PairPlaces pair_places(const GearPair& pair) {
  const double planet = half_tooth_at_pitch(pair, pair.pinion());
  // A sun sees the planet's pitch point at the angle pi of the planet, a ring at the angle 0.
  return {pair.internal() ? planet : std::numbers::pi - planet, -half_tooth_at_pitch(pair, pair.wheel())};
}

double planet_place(const GearPair& sun_mesh, double phi, double lag) {
  return phi + pair_places(sun_mesh).pinion + lag * sun_mesh.pinion().pitch_angle();
}

StagePlaces stage_places(const PlanetarySet& set) {
  StagePlaces places;
  places.sun = set.planet_angle(0) + pair_places(set.sun_mesh()).wheel - set.sun_phase_lag(0) * set.sun().pitch_angle();
  // The ring turns clockwise, too: so many cycles later its leading flank is at the pitch point of planet 0.
  places.ring =
      set.planet_angle(0) + pair_places(set.ring_mesh()).wheel + set.ring_phase_lag(0) * set.ring().pitch_angle();
  for (int n = 0; n < set.planets(); ++n)
    places.planets.push_back(planet_place(set.sun_mesh(), set.planet_angle(n), set.sun_phase_lag(n)));
  return places;
}

ActionLine action_line(const GearPair& pair) {
  const double angle = pair.working_pressure_angle(), base = pair.pinion().base_radius();
  // The string that makes a leading flank leaves the base circle counter-clockwise and so far behind the contact; of a
  // trailing flank it is the mirror image. They meet the pitch point at the planet's angle pi (sun) and 0 (ring).
  const double tangent = pair.internal() ? angle : std::numbers::pi - angle;
  const double sign = pair.internal() ? -1 : 1;
  const Eigen::Vector2d radial(std::cos(tangent), std::sin(tangent));
  return {Eigen::Vector2d(pair.centre_distance(), 0) + base * radial, {-sign * radial.y(), sign * radial.x()}};
}

}  // namespace annulus::geometry
