#include <cmath>
#include <utility>

#include "dynamics/systems/planetary/stage_forms.h"

namespace annulus::dynamics {

namespace {

using Kind = StageBody::Kind;
using Forms = std::vector<LinearForm>;

SpaceBody data_of(const PlanetaryStage& stage, const StageBody& body) {
  const auto& tilt = stage.space->tilt_inertia;
  const auto& off = stage.space->mass_place;
  const auto spin = [&](double speed) { return stage.rotating_frame ? speed : 0; };
  const auto central = [&](const CentralBody& b, double across, double place, double speed) {
    return SpaceBody{
        body, b.mass, b.inertia, b.radius, across, place, spin(speed), b.torsional_support, stage.damping_ratio_of(b)};
  };
  switch (body.kind) {
    case Kind::sun:
      return central(stage.sun, tilt.sun, off.sun, stage.sun_speed());
    case Kind::ring: {
      auto ring = central(stage.ring, tilt.ring, off.ring, stage.ring_speed);
      if (const auto* coupling = stage.space->coupling_that_turns(body))
        ring.torsional_support = coupling->stiffness.bottomRightCorner<1, 1>().value();
      ring.torsional_support += stage.space->ring_mounts / (ring.radius * ring.radius);
      return ring;
    }
    case Kind::carrier:
      return central(stage.carrier, tilt.carrier, off.carrier, stage.carrier_speed);
    default: {
      const auto& planet = stage.planet;
      return {body,
              planet.mass,
              planet.inertia,
              planet.radius,
              tilt.planet,
              0,
              spin(stage.planet_speed()),
              0,
              stage.damping_ratio_of(planet)};
    }
  }
}

/// Coordinates (x, y, z, about x, about y) of body `on` in the middle of a body, in the axes of the latter. `b`: its
/// own, in its middle.
Forms seat(const PlanetaryStage& stage, const BodyForms& b, const StageBody& body, const StageBody& on) {
  if (body.kind != Kind::planet) return {b.x, b.y, b.z, b.tilt_x, b.tilt_y};
  const double phi = stage.planet_angles[static_cast<std::size_t>(body.planet)];
  const double c = std::cos(phi), s = std::sin(phi), a = stage.carrier.radius;
  const LinearForm about_radial = c * b.tilt_x + s * b.tilt_y, about_tangential = (-s) * b.tilt_x + c * b.tilt_y;
  return {c * b.x + s * b.y, (-s) * b.x + c * b.y + (a / data_of(stage, on).radius) * b.u,
          b.z + (-a) * about_tangential, about_radial, about_tangential};
}

/// The centrifugal preload of a planet's bearing, which turns and tilts with the carrier (see assemble.cc).
void add_centrifugal(LumpedSystemBuilder& builder, const PlanetaryStage& stage, const StageForms& forms, int n) {
  const double speed = stage.rotating_frame ? stage.carrier_speed : 0;
  const double centrifugal = stage.planet.mass * speed * speed, a = stage.carrier.radius;
  const double phi = stage.planet_angles[static_cast<std::size_t>(n)];
  const auto& carrier = forms.carrier;
  const auto& planet = forms.planets[static_cast<std::size_t>(n)];
  const LinearForm translation = (-std::sin(phi)) * carrier.x + std::cos(phi) * carrier.y;
  const LinearForm tilt = a * ((-std::sin(phi)) * carrier.tilt_x + std::cos(phi) * carrier.tilt_y);
  builder.add_rotating_stiffness(planet.y, carrier.u, 2 * centrifugal);
  builder.add_rotating_stiffness(carrier.u, carrier.u, -centrifugal);
  builder.add_rotating_stiffness(translation, carrier.u, -2 * centrifugal);
  // The radial direction of the seat tilts with the carrier: m a Omega^2 (-a tilt^2 / 2 - z tilt) of a planet at z.
  builder.add_rotating_stiffness(tilt, tilt, -centrifugal);
  builder.add_rotating_stiffness(planet.z, tilt, -2 * centrifugal);
  builder.add_rotating_stiffness(carrier.z, tilt, 2 * centrifugal);
}

const BodyForms& forms_of(const StageForms& bodies, const StageBody& body) {
  if (body.kind == Kind::planet) return bodies.planets[static_cast<std::size_t>(body.planet)];
  return body.kind == Kind::sun ? bodies.sun : body.kind == Kind::ring ? bodies.ring : bodies.carrier;
}

}  // namespace

StageForms add_bodies_in_space(LumpedSystemBuilder& builder, const PlanetaryStage& stage) {
  std::vector<SpaceBody> bodies;
  for (const auto kind : {Kind::sun, Kind::ring, Kind::carrier}) bodies.push_back(data_of(stage, {kind}));
  for (int n = 0; n < stage.planets(); ++n) bodies.push_back(data_of(stage, {Kind::planet, n}));
  const SpaceFrame frame{stage.rotating_frame ? stage.carrier_speed : 0, stage.carrier_speed};
  auto forms = add_space_bodies(builder, *stage.space, bodies, frame,
                                [&](const std::vector<BodyForms>& known, const StageBody& body, const StageBody& on) {
                                  if (on.kind == Kind::housing) return seat_in_housing();
                                  for (std::size_t i = 0; i < known.size(); ++i)
                                    if (bodies[i].body == on) return seat(stage, known[i], body, on);
                                  return seat(stage, {}, body, on);
                                });
  StageForms result{forms[0], forms[1], forms[2], {forms.begin() + 3, forms.end()}};
  for (int n = 0; n < stage.planets(); ++n) add_centrifugal(builder, stage, result, n);
  return result;
}

std::vector<LinearForm> relative_motion(const PlanetaryStage& stage, const StageForms& bodies, const StageBody& body,
                                        const StageBody& on) {
  return against(forms_of(bodies, body),
                 on.kind == Kind::housing ? seat_in_housing() : seat(stage, forms_of(bodies, on), body, on));
}

std::vector<LinearForm> bearing_motion(const PlanetaryStage& stage, const StageForms& bodies,
                                       const LinearBearing& bearing) {
  return at_place(relative_motion(stage, bodies, bearing.body, bearing.on), bearing.place);
}

// With the normal n = c e + s z of the flanks and a contact at rho_T + z: n . (phi x rho) / c = phi . (rho_T x e) +
// tan(beta_b) phi . (rho_T x z) + z phi . (z x e). The first term is the plane's u.
MeshOutOfPlane mesh_out_of_plane(const PlanetaryStage& stage, const StageForms& bodies, MeshWith with, int planet) {
  const bool of_sun = with == MeshWith::sun;
  const auto& space = *stage.space;
  const auto n = static_cast<std::size_t>(planet);
  const double phi = stage.planet_angles[n], tangent = std::tan(space.base_helix_angle);
  const auto& wheel = of_sun ? bodies.sun : bodies.ring;
  const auto& own = bodies.planets[n];
  const LinearForm wheel_radial = std::cos(phi) * wheel.tilt_x + std::sin(phi) * wheel.tilt_y;
  const LinearForm wheel_tangential = (-std::sin(phi)) * wheel.tilt_x + std::cos(phi) * wheel.tilt_y;
  const auto& face = of_sun ? space.sun_face : space.ring_face;
  const double alpha = of_sun ? stage.sun_working_angle : stage.ring_working_angle;
  const double from_planet = of_sun ? -space.planet_working_radius_sun : space.planet_working_radius_ring;
  const double from_wheel = stage.carrier.radius + from_planet;
  // The driving body is 1: the sun, of ring meshes the planet.
  const double sign = of_sun ? 1 : -1;
  MeshOutOfPlane result;
  const double across_r = of_sun ? -std::cos(alpha) : std::cos(alpha), across_t = std::sin(alpha);  // z x e
  const LinearForm slope =
      sign * (across_r * (wheel_radial + (-1.0) * own.tilt_x) + across_t * (wheel_tangential + (-1.0) * own.tilt_y));
  result.approach = (sign * tangent) * (wheel.z + (-1.0) * own.z) +
                    (-sign * tangent) * (from_wheel * wheel_tangential + (-from_planet) * own.tilt_y) +
                    face.middle * slope;
  result.tilt = (face.width / 2) * slope;
  return result;
}

}  // namespace annulus::dynamics
