#pragma once

#include <vector>

#include "geometry/gear_pair.h"

namespace annulus::geometry {

/// A single-stage planetary set. The hands of helical gears follow from the planet's: the
/// sun has the opposite one, the ring the same. Phases are those of the transverse sections at z = 0. Construction
/// throws GeometryError with the reason: planets where they do not fit between the teeth (see `assembly_angle`),
/// planets that collide (tip circles nearer than `planet_clearance`), and all that GearPair refuses.
class PlanetarySet {
 public:
  /// Equally spaced planets: (z_s + z_r) / N has to be whole.
  PlanetarySet(const Gear& sun, const Gear& planet, const Gear& ring, double centre_distance, int planets);
  /// Planets at these angles (rad), 0 and further ones, each within `angle_tolerance` of a place where it can be
  /// assembled; that place is taken.
  PlanetarySet(const Gear& sun, const Gear& planet, const Gear& ring, double centre_distance,
               const std::vector<double>& planet_angles);

  [[nodiscard]] int planets() const { return static_cast<int>(steps_.size()); }
  [[nodiscard]] const GearPair& sun_mesh() const { return sun_mesh_; }
  [[nodiscard]] const GearPair& ring_mesh() const { return ring_mesh_; }
  [[nodiscard]] const Gear& sun() const { return sun_mesh_.wheel(); }
  [[nodiscard]] const Gear& planet() const { return sun_mesh_.pinion(); }
  [[nodiscard]] const Gear& ring() const { return ring_mesh_.wheel(); }
  [[nodiscard]] double centre_distance() const { return sun_mesh_.centre_distance(); }
  [[nodiscard]] double planet_angle(int n) const;  ///< phi_n, rad, counter-clockwise of planet 0; n = 0 ... N-1
  /// Least angle between two places where a planet fits between sun and ring, rad: 2 pi / (z_s + z_r).
  [[nodiscard]] double assembly_angle() const;
  /// Ring teeth by which planet n stands ahead of planet 0, not whole in general: z_r phi_n / 2 pi.
  [[nodiscard]] double ring_teeth_ahead(int n) const;

  /// Rounding of angles written with two decimals of a degree; rad.
  static constexpr double angle_tolerance = 1.75e-4;

  /// Room between the tip circles of neighbouring planets, modules: a fifth of a module for lubricant and deflection.
  static constexpr double planet_clearance = 0.2;

  /// Mesh phasing [ParkerLin2004], derived from the geometry, in mesh cycles in [0, 1).
  /// At time t the sun mesh of planet n is at phase f t - sun_phase_lag(n), its ring mesh at f t - ring_phase_lag(n),
  /// f being the mesh frequency and phase 0 the pitch-point contact of a tooth pair (see StiffnessTable).
  /// sun_phase_lag(0) = 0. Seen from the carrier the sun drives counter-clockwise, planets and ring turn clockwise, and
  /// planet n sits at phi_n counter-clockwise of planet 0. The sun touches the planets' leading flanks, the planets
  /// touch the ring with their trailing flanks; both meshes touch with their driving flanks, backlash lies behind them.
  /// In closed form gamma_sn = z_s phi_n / 2 pi, gamma_rn = gamma_rs - z_r phi_n / 2 pi (whole cycles dropped), with
  /// gamma_rs = ring_phase_lag(0) = z_p (pi - psi_s - psi_r) / 2 pi and psi the planet's tooth half angles at its two
  /// working pitch circles.
  [[nodiscard]] double sun_phase_lag(int n) const;
  [[nodiscard]] double ring_phase_lag(int n) const;
  /// Mesh cycles, whole ones included, from the contact of a planet's tooth with the sun to that with the ring, in
  /// their pitch points: gamma_rs is its fraction.
  [[nodiscard]] double cycles_from_sun_to_ring() const;
  /// Whole number of mesh cycles that makes `f t - ring_phase_lag(n) + ring_tooth_offset(n)` the ring position
  /// coordinate of planet n: where it stands on a ring that does not repeat with every tooth. The coordinate grows by
  /// one when a planet has passed one ring tooth; seen from the ring the planets travel counter-clockwise, and at the
  /// same time planet n is exactly ring_teeth_ahead(n) ahead of planet 0. ring_tooth_offset(0) = 0. The coordinate is
  /// whole when a leading flank of the ring touches at the planet's pitch point.
  [[nodiscard]] double ring_tooth_offset(int n) const;

 private:
  [[nodiscard]] int step(int n) const;
  [[nodiscard]] int whole_turn() const { return sun().teeth() + ring().teeth(); }
  void check_room() const;

  GearPair sun_mesh_, ring_mesh_;
  std::vector<int> steps_;  ///< phi_n in assembly angles
};

}  // namespace annulus::geometry
