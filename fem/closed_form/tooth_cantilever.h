#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "fem/closed_form/plane_moduli.h"
#include "geometry/profile.h"

namespace annulus::fem {

/// A tooth, external or internal, as a cantilever of variable section on its body: energy method, per metre of width.
///
/// Tooth 0's own frame (see geometry/profile.h): x along its centre line, y across. A unit force normal to the leading
/// flank crosses the centre line at x_c, where it splits into a transverse part F_y, an axial part F_x and no moment.
/// Between x_c and the root at x_0 the energy is, for bending, shear and axial compression
/// [WeberBanaschek1953; YangLin1987],
///
///     delta = int [ F_y^2 (x_c - x)^2 / (E' I) + 1.2 F_y^2 / (G A) + F_x^2 / (E' A) ] |dx|,  A = 2y, I = (2y)^3 / 12
///
/// with y(x) the true half-thickness: involute and fillet. The sense of x does not enter, so that an internal tooth,
/// which points inwards and grows thicker outwards, needs no formulas of its own.
class ToothCantilever {
 public:
  ToothCantilever(const geometry::ToothProfile& profile, const PlaneModuli& moduli);

  /// The root: arc on the root circle over which the tooth passes its load to the body.
  [[nodiscard]] double root_radius() const { return root_radius_; }          ///< m
  [[nodiscard]] double root_half_angle() const { return root_half_angle_; }  ///< rad

  /// What a unit normal force on the leading flank does, in the tooth's own frame.
  struct Load {
    Eigen::Vector3d root;   ///< on the root: axial force, transverse force, moment about the arc's centroid (m)
    double compliance = 0;  ///< of the cantilever alone, m/(N/m)
    double depth = 0;       ///< m, from the flank to the centre line along the force
  };
  [[nodiscard]] Load load(double roll_length) const;

 private:
  const geometry::ToothProfile profile_;
  PlaneModuli moduli_;
  double root_radius_ = 0, root_half_angle_ = 0;
  std::vector<std::pair<double, double>> outline_;  ///< (x, half-thickness), from the root to the tip
};

/// Compliance of a cantilever under a transverse force `force.y()` and an axial force `force.x()` at `x_load`; the
/// outline is a polygon of (x, half-thickness) that starts at the root. Each piece is integrated exactly in x for its
/// linear thickness.
[[nodiscard]] double cantilever_compliance(const std::vector<std::pair<double, double>>& outline, double x_load,
                                           const Eigen::Vector2d& force, const PlaneModuli& moduli);

}  // namespace annulus::fem
