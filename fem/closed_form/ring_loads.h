#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "fem/closed_form/ring_harmonics.h"

namespace annulus::fem {

/// How a force is spread over an arc of half-angle beta.
enum class Spread { uniform, parabolic };

enum class Circle { inner, outer };

/// Circumferential harmonics (radial, tangential), from 0, of a unit load on one circle of a ring, placed at angle
/// zero; 1/rad, see HarmonicCompliance for their meaning. Even loads have the radial part symmetric about their place,
/// odd ones antisymmetric.
struct RingHarmonics {
  Circle circle = Circle::inner;
  bool odd = false;
  std::vector<Eigen::Vector2d> terms;
};

/// Unit force in the fixed direction of the radius outwards, or of the tangent counter-clockwise, at the middle of the
/// arc. Its line of action is that of the middle; the tangential one acts at the radius `centroid_radius`.
[[nodiscard]] RingHarmonics radial_force(Circle circle, double half_angle, Spread spread, int harmonics);
[[nodiscard]] RingHarmonics tangential_force(Circle circle, double half_angle, Spread spread, int harmonics);
/// Unit counter-clockwise moment: radial tractions that grow linearly from the middle of the arc, without resultant, as
/// a beam's bending stresses on its root.
[[nodiscard]] RingHarmonics moment(Circle circle, double radius, double half_angle, int harmonics);
/// Radius of the centroid of an arc under the load, m.
[[nodiscard]] double centroid_radius(double radius, double half_angle, Spread spread);

/// Compliance between two loads on one ring as a function of the angle between them.
class HarmonicCoupling {
 public:
  /// Displacement in the sense of the first load, placed at `angle` (rad), under the second one at angle zero, m/(N/m).
  [[nodiscard]] double operator()(double angle) const;
  /// The same at all differences between some angles and those of some sources: a row per angle, a column per source.
  /// As a matrix product, some ten times faster.
  [[nodiscard]] Eigen::MatrixXd operator()(const std::vector<double>& angles, const std::vector<double>& sources) const;

 private:
  friend class RingSeries;
  bool sine_ = false;
  std::vector<double> terms_;
};

/// A ring as the sum of its harmonics.
class RingSeries {
 public:
  using Compliance = std::function<HarmonicCompliance(int harmonic)>;
  RingSeries(const Compliance& compliance, int harmonics);

  /// Displacement in the sense of `load` under `source`. Terms beyond the shortest of the series are left out, and
  /// those that have died away to round-off.
  [[nodiscard]] HarmonicCoupling coupling(const RingHarmonics& load, const RingHarmonics& source) const;

 private:
  std::vector<HarmonicCompliance> compliance_;
};

}  // namespace annulus::fem
