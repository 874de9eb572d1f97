#pragma once

#include <limits>

namespace annulus {

/// Force of a rolling bearing with play over the distance of its rings' centres.
///
/// Many equal rollers of linear stiffness stand around the bearing; those carry whose raceways have approached each
/// other by more than the play. With the distance d, the radial play p and the half load zone z = arccos(p / d) their
/// forces add up to [HarrisKotzalas2006, load distribution of radially loaded bearings], here with an exponent of 1,
///
///   F = K (2 / pi) (z - sin z cos z) d   for d > p,
///
/// which is K d without play. The seat of the bearing, a pin say, gives way in series. Within the play 1e-7 of K is
/// left, so that an unloaded body has a place.
class RadialBearing {
 public:
  RadialBearing() = default;
  /// `stiffness`: K, N/m, without play. `play`: p, m, half the radial clearance (ISO 5753-1). `seat`: N/m. Throws
  /// InputError unless stiffness and seat are positive, the stiffness finite and the play finite and not negative.
  RadialBearing(double stiffness, double play, double seat = std::numeric_limits<double>::infinity());

  struct Value {
    double force = 0, slope = 0;  ///< N, N/m
  };
  /// At a distance d >= 0, m.
  [[nodiscard]] Value operator()(double distance) const;
  [[nodiscard]] double energy(double distance) const;  ///< J
  /// The distance under a force >= 0 (N), m.
  [[nodiscard]] double distance(double force) const;
  /// Angle over which rollers carry under a force (N), rad: 0 to pi.
  [[nodiscard]] double load_zone(double force) const;
  /// What the rollers carry under a force (N) at an angle (rad) from the middle of the load zone, N/rad.
  [[nodiscard]] double roller_load(double force, double angle) const;

 private:
  [[nodiscard]] Value of_rollers(double distance) const;
  /// Distance of the rings under their share of the whole one.
  [[nodiscard]] double between_rings(double distance) const;
  [[nodiscard]] double between_rings_under(double force) const;

  double stiffness_ = 1, play_ = 0, seat_ = std::numeric_limits<double>::infinity();
};

}  // namespace annulus
