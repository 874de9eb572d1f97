#pragma once

#include <set>
#include <vector>

#include "benchmarks/calculix/quadratic_body.h"
#include "benchmarks/calculix/stage_job.h"
#include "geometry/planetary.h"

namespace annulus::benchmarks {

/// How sun, planets and ring stand in the frame of the ring at some mesh cycles, and which teeth are near contact
/// (PlanetarySet::sun_phase_lag and the following).
struct StagePlaces {
  std::vector<double> planet_direction, planet_angle;  ///< rad, of the planets' axes and of their teeth 0
  double sun_angle = 0;
  std::vector<FlankPair> pairs;  ///< reach: 1 within the path of contact, 2 beyond it
};
/// Of the first planets.
[[nodiscard]] StagePlaces places_at(const geometry::PlanetarySet& set, double cycles, int planets);

enum class PeerMesh {
  own,        ///< cells along the flank as long as half the width of the contact
  of_annulus  ///< the first level of annulus, three times the nodes
};
/// A gear in its own frame; `contact_teeth` have the fine mesh.
[[nodiscard]] QuadraticBody gear_body(const geometry::Gear& gear, double support_radius, PeerMesh mesh,
                                      const std::set<int>& contact_teeth);

/// The bodies of a stage job in position, with planets in the number of `places`. Multiplies the reach of the pairs.
struct StageRadii {
  double sun_bore = 0, planet_bore = 0, ring_outside = 0;  ///< m
};
void add_bodies(StageJob& job, const geometry::PlanetarySet& set, const StageRadii& radii, StagePlaces places,
                double reach, PeerMesh mesh);

}  // namespace annulus::benchmarks
