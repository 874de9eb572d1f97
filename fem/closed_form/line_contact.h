#pragma once

#include <limits>

#include "fem/material.h"

namespace annulus::fem {

/// Elastic approach of two flanks in line contact: each a half space under the pressure of Hertz, its surface against
/// the point on the contact normal at a depth h, where the tooth's centre line lies and the beam begins.
///
///     delta = 2 (1 - nu^2) F' / (pi E) [asinh(h/b) - nu/(1-nu) (h/b) (sqrt(1 + (h/b)^2) - h/b)]     for each body
///
/// with the half-width b = sqrt(4 F' / (pi E* kappa)), E* = E / (2 (1 - nu^2)). It follows from the stresses on the
/// axis below the contact (Johnson, Contact Mechanics, eq. 4.46) by integration of the strain, plane strain; deep below
/// the contact, h >> b, it is ln(2h/b) - nu / (2 (1 - nu)), the form of Weber and Banaschek (1953) and of Johnson's
/// eq. 5.57. The logarithm makes it grow less than in proportion to the load.
///
/// A tip edge at the distance s along the flank makes its body softer: the image of the load beyond the edge frees the
/// tip face of shear (not of its small normal stress, so that it is a lower bound) and adds
/// ln(1 + (h / 2d)^2) / 2 to the bracket, d = s + b/2 being the distance of the pressure's middle from the edge. It
/// applies within `edge_range` half-widths, fading out linearly.
class LineContact {
 public:
  static constexpr double edge_range = 1.5;

  struct Body {
    double depth = 0;                                       ///< m, h
    double edge = std::numeric_limits<double>::infinity();  ///< m, s; infinite: no tip edge on this side
  };
  /// `relative_curvature` kappa in 1/m; `width` of the contact in m.
  LineContact(double relative_curvature, const Body& planet, const Body& wheel, const Material& material, double width);

  [[nodiscard]] double half_width(double force) const;     ///< b, m
  [[nodiscard]] double peak_pressure(double force) const;  ///< Hertz, Pa
  [[nodiscard]] double approach(double force) const;       ///< m, both bodies
  [[nodiscard]] double compliance(double force) const;     ///< d approach / d force, m/N; force > 0

 private:
  double curvature_, width_;
  Body planet_, wheel_;
  Material material_;
};

}  // namespace annulus::fem
