#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/elastic_law.h"
#include "dynamics/spatial/stage_bodies.h"

namespace annulus::dynamics {

/// A row of rolling elements between the rings of a bearing, of steel.
struct RollingRow {
  enum class Element { roller, ball };
  /// Which of its rings the supported body has.
  enum class Ring { inner, outer };
  Element element = Element::roller;
  int count = 0;
  double diameter = 0;        ///< m
  double length = 0;          ///< m, effective, of rollers
  double pitch_diameter = 0;  ///< m, on which the middles of the elements lie; needed by balls and by a contact angle
  /// rad, of the contacts with the transverse plane, without load. Positive: the row resists a displacement of the body
  /// along +z, negative: one along -z.
  double contact_angle = 0;
  double clearance = 0;  ///< m, radial; negative: preload
  /// Radii of the grooves across the balls' path over the balls' diameter.
  double inner_groove = 0.52, outer_groove = 0.53;
  Ring ring = Ring::inner;
  bool operator==(const RollingRow&) const = default;
};

/// Force and moment of a row on the body in its place.
class RollingRowLaw : public ElasticLaw {
 public:
  /// Of x, y, z (0, 1, 2), about x and about y (3, 4), those on which it acts.
  [[nodiscard]] const std::vector<int>& coordinates() const { return coordinates_; }
  [[nodiscard]] int size() const final { return static_cast<int>(coordinates_.size()); }
  /// N, of the most loaded element.
  [[nodiscard]] virtual double largest_element_load(const Eigen::VectorXd& deflection) const = 0;

 protected:
  explicit RollingRowLaw(std::vector<int> coordinates) : coordinates_(std::move(coordinates)) {}

 private:
  std::vector<int> coordinates_;
};

/// The law of a row, Hertz contacts after [ISO16281]. The first element stands on the x axis. In the plane z and the
/// tilts are left out. Throws InputError for sizes that are not positive, fewer than three elements, elements that
/// overlap or reach the axis, a contact angle of a right angle or more, and a clearance beyond the grooves.
///
/// Rollers are cut into slices along their length, whose force is c_s delta^(10/9) with c_s = 35948 N/mm^(10/9)
/// (L_we / mm)^(8/9) over the number of slices. delta is the approach of the raceways along the contact angle at the
/// slice, less the clearance and the logarithmic profile of the roller at both raceways. The force of the rib of a
/// tapered roller is left out.
///
/// Balls have the force c delta^(3/2), where delta is by how much the centres of the grooves' curvature are further
/// apart than in touch; it acts along the line through both, so that the contact angle follows the load.
[[nodiscard]] std::shared_ptr<const RollingRowLaw> law_of(const RollingRow& row, Motions motions);

/// Contact of two bodies of one material in a point: by Hertz.
struct PointContact {
  double major = 0, minor = 0;  ///< m, half axes of the ellipse
  double approach = 0;          ///< m
};
/// `load`: N. `curvature_sum`: 1/m, of all four principal curvatures, hollow ones negative. `curvature_difference`:
/// that between the two planes over the sum, 0 to less than 1. `modulus`: E / (1 - nu^2), Pa.
[[nodiscard]] PointContact point_contact(double load, double curvature_sum, double curvature_difference,
                                         double modulus);

}  // namespace annulus::dynamics
