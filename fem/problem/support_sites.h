#pragma once

#include <limits>
#include <vector>

#include "fem/problem/material.h"

namespace annulus::fem {

/// One way in which a support presses on the ring.
struct SupportDirection {
  double inward = 1, counter_clockwise = 0;  ///< unit vector of the force on the ring
  bool unilateral = true;
  double clearance = 0;  ///< m
  double stiffness = 0;  ///< N/m, spread evenly over the face width
  /// N/m, of both ends of the support together, each taking its share by the lever rule, in series with `stiffness`.
  double end_stiffness = std::numeric_limits<double>::infinity();
  [[nodiscard]] double total_stiffness() const { return 1 / (1 / stiffness + 1 / end_stiffness); }
};

/// One supported arc of the outside of a ring.
struct SupportSite {
  double angle = 0;       ///< rad, polar angle in the frame of the solve
  double half_arc = 0;    ///< rad
  bool parabolic = true;  ///< pressure over the arc: parabola, else uniform
  std::vector<SupportDirection> directions;
};

/// The supports around a ring: pins or spline teeth, then the patches of a housing bore, one behind every tooth.
struct SupportSites {
  std::vector<SupportSite> sites;
  int pins = 0;  ///< number of pins or spline teeth: the first sites
  /// A torque, spread evenly over the whole surface, holds it against turning in the mean and gives way nowhere else.
  bool against_turning = false;
};

/// What the supports touch.
struct SupportedRing {
  int teeth = 0;
  double outside_radius = 0;  ///< m
  double face_width = 0;      ///< m
  Material material;
};

/// `count` equally spaced angles, rad.
[[nodiscard]] std::vector<double> equal_angles(int count, double first);

}  // namespace annulus::fem
