#pragma once

#include <Eigen/Core>

#include "dynamics/spatial/linear_supports.h"

namespace annulus::dynamics {

/// What a stage has beside that of the plane (PlanetaryStage) where its bodies move along the axis and tilt. All of its
/// supports but the torsional ones are `bearings`.
struct StageSpace : SpaceSupports {
  double base_helix_angle = 0;  ///< rad, signed: > 0 for right-handed planets
  /// m, of the working pitch points from the planets' axes.
  double planet_working_radius_sun = 0, planet_working_radius_ring = 0;
  SpreadFace sun_face, ring_face;  ///< gaps of the transverse section
  struct TiltInertia {
    double sun = 0, ring = 0, carrier = 0, planet = 0;  ///< kg m^2, about axes across the body's own
  };
  TiltInertia tilt_inertia;
  struct MassPlace {
    double sun = 0, ring = 0, carrier = 0;  ///< m, z of the centres of mass; those of planets are in their middle
  };
  MassPlace mass_place{};
  double ring_mounts = 0;  ///< N m/rad, of mounts beside the axis against a turn of the ring
  /// Throws InputError with name and value of the quantity that cannot be used.
  void check(int planets) const;
};

}  // namespace annulus::dynamics
