#include "benchmarks/calculix/stage_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/errors.h"
#include "fem/body/resolution.h"
#include "geometry/profile.h"
#include "geometry/sector_mesh.h"

namespace annulus::benchmarks {

StagePlaces places_at(const geometry::PlanetarySet& set, double cycles, int planets) {
  const auto &sun = set.sun(), &planet = set.planet(), &ring = set.ring();
  const auto &sun_mesh = set.sun_mesh(), &ring_mesh = set.ring_mesh();
  const double pitch = planet.base_pitch();
  const auto half = [](const geometry::Gear& gear, double working_angle) {
    return gear.tooth_half_angle(gear.base_radius() / std::cos(working_angle));
  };
  const double sun_angle = sun_mesh.working_pressure_angle(), ring_angle = ring_mesh.working_pressure_angle();
  const auto phase_of = [](double value) { return value - std::floor(value + 1e-12); };
  const auto tooth = [](double value, int teeth) {
    const double whole = std::round(value);
    require(std::abs(value - whole) < 1e-6, "teeth are counted by whole numbers");
    return ((static_cast<int>(whole) % teeth) + teeth) % teeth;
  };
  // Pairs so far beyond their path of contact do not touch: their gap is wider than the deflection of these meshes.
  const double beyond_path = 0.13 * pitch;
  const geometry::ToothProfile planet_profile(planet);
  StagePlaces place;
  for (int n = 0; n < planets; ++n) {
    const double ring_position = cycles - set.ring_phase_lag(n) + set.ring_tooth_offset(n);
    const double direction = ring.pitch_angle() * ring_position + half(ring, ring_angle);
    const double turned = cycles - set.sun_phase_lag(n);
    if (n == 0) place.sun_angle = direction - half(sun, sun_angle) + sun.pitch_angle() * cycles;
    const double angle = direction + std::numbers::pi - half(planet, sun_angle) - planet.pitch_angle() * turned;
    place.planet_direction.push_back(direction);
    place.planet_angle.push_back(angle);
    const Eigen::Vector2d axis = Eigen::Rotation2Dd(direction) * Eigen::Vector2d(set.centre_distance(), 0);
    for (const bool with_ring : {false, true}) {
      const auto& mesh = with_ring ? ring_mesh : sun_mesh;
      const double phase = phase_of(with_ring ? cycles - set.ring_phase_lag(n) : turned);
      for (int k = -4; k <= 4; ++k) {
        const double passed = phase + k;  // mesh cycles since the pitch point
        // The planet is driven from its tip to its root by the sun, and drives the ring the other way.
        const double roll = mesh.roll_length_pitch() + (with_ring ? passed : -passed) * pitch;
        const double beyond = std::max(mesh.roll_length_low() - roll, roll - mesh.roll_length_high());
        if (beyond > beyond_path) continue;
        FlankPair pair;
        pair.planet = n;
        pair.with_ring = with_ring;
        pair.planet_tooth = tooth(turned - passed - (with_ring ? set.cycles_from_sun_to_ring() : 0), planet.teeth());
        pair.wheel_tooth =
            with_ring
                ? tooth(ring_position - passed, ring.teeth())
                : tooth(passed - cycles + sun.teeth() * set.planet_angle(n) / (2 * std::numbers::pi), sun.teeth());
        Eigen::Vector2d point =
            planet_profile.flank_point(std::clamp(roll, mesh.roll_length_low(), mesh.roll_length_high()));
        if (with_ring) point.y() = -point.y();
        pair.place = axis + Eigen::Rotation2Dd(angle + pair.planet_tooth * planet.pitch_angle()) * point;
        pair.reach = beyond > 0 ? 2 : 1;
        place.pairs.push_back(pair);
      }
    }
  }
  return place;
}

QuadraticBody gear_body(const geometry::Gear& gear, double support_radius, PeerMesh mesh,
                        const std::set<int>& contact_teeth) {
  geometry::SectorResolution own;
  own.flank_cells = 44, own.fillet_cells = 6, own.root_cells = 1, own.thickness_cells = 10, own.rim_cells = 8;
  own.flank_layer = 0.15;
  constexpr int level = 1;
  const auto sector = geometry::make_sector_mesh(
      gear, {support_radius, {}}, mesh == PeerMesh::own ? own : fem::plane_resolution(gear, level).section);
  return make_gear(geometry::ToothProfile(gear), sector, support_radius, contact_teeth);
}

void add_bodies(StageJob& job, const geometry::PlanetarySet& set, const StageRadii& radii, StagePlaces places,
                double reach, PeerMesh mesh) {
  std::set<int> sun_teeth, ring_teeth;
  std::vector<std::set<int>> planet_teeth(places.planet_angle.size());
  for (auto& pair : places.pairs) {
    pair.reach *= reach;
    planet_teeth[pair.planet].insert(pair.planet_tooth);
    (pair.with_ring ? ring_teeth : sun_teeth).insert(pair.wheel_tooth);
  }
  job.sun.body = gear_body(set.sun(), radii.sun_bore, mesh, sun_teeth);
  job.sun.body.place(places.sun_angle, Eigen::Vector2d::Zero());
  for (std::size_t n = 0; n < places.planet_angle.size(); ++n) {
    HubGear planet{gear_body(set.planet(), radii.planet_bore, mesh, planet_teeth[n]),
                   Eigen::Rotation2Dd(places.planet_direction[n]) * Eigen::Vector2d(set.centre_distance(), 0),
                   {}};
    planet.body.place(places.planet_angle[n], planet.axis);
    job.planets.push_back(std::move(planet));
  }
  job.ring = gear_body(set.ring(), radii.ring_outside, mesh, ring_teeth);
  job.pairs = std::move(places.pairs);
}

}  // namespace annulus::benchmarks
