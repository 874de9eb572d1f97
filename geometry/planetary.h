#pragma once

#include <vector>

#include "geometry/gear_pair.h"

namespace annulus::geometry {

/// A single-stage planetary set with equally spaced planets, ring fixed to its structure.
/// Construction throws GeometryError with the reason: assembly condition (z_s + z_r) / N not whole, planets collide,
/// and all that GearPair refuses.
class PlanetarySet {
 public:
  PlanetarySet(const Gear& sun, const Gear& planet, const Gear& ring, double centre_distance, int planets);

  [[nodiscard]] int planets() const { return planets_; }
  [[nodiscard]] const GearPair& sun_mesh() const { return sun_mesh_; }
  [[nodiscard]] const GearPair& ring_mesh() const { return ring_mesh_; }
  [[nodiscard]] const Gear& sun() const { return sun_mesh_.wheel(); }
  [[nodiscard]] const Gear& planet() const { return sun_mesh_.planet(); }
  [[nodiscard]] const Gear& ring() const { return ring_mesh_.wheel(); }
  [[nodiscard]] double centre_distance() const { return sun_mesh_.centre_distance(); }
  [[nodiscard]] double planet_angle(int n) const;  ///< phi_n = 2 pi n / N, n = 0 ... N-1

  /// Mesh phasing (Parker and Lin, J. Mech. Des. 126, 2004), derived from the geometry, in mesh cycles in [0, 1).
  /// At time t the sun mesh of planet n is at phase f t - sun_phase_lag(n), its ring mesh at f t - ring_phase_lag(n),
  /// f being the mesh frequency and phase 0 the pitch-point contact of a tooth pair (see StiffnessTable).
  /// sun_phase_lag(0) = 0. The sun drives counter-clockwise seen from the carrier, the planets sit counter-clockwise.
  [[nodiscard]] double sun_phase_lag(int n) const;
  [[nodiscard]] double ring_phase_lag(int n) const;
  /// Whole ring teeth passed between planet 0 and planet n: where planet n stands on a ring that does not repeat with
  /// every tooth. The ring position coordinate of planet n is f t - ring_phase_lag(n) + ring_tooth_offset(n) in mesh
  /// cycles: planet n at time 0 stands exactly n z_r / N ring teeth further (in the direction in which planet 0 moves
  /// along the ring with growing time) than planet 0.
  [[nodiscard]] double ring_tooth_offset(int n) const;

 private:
  GearPair sun_mesh_, ring_mesh_;
  int planets_;
};

}  // namespace annulus::geometry
