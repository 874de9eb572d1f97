#pragma once

#include "fem/elasticity/nodal_load.h"
#include "fem/elasticity/sector_model.h"

namespace annulus::fem {

/// A unit force spread over an arc of the outside of a ring and over a slice of its width, seen by one sector.
struct ArcLoad {
  double centre = 0;      ///< rad, polar angle of the middle of the arc in the sector's frame, may lie beyond its cuts
  double half_arc = 0;    ///< rad
  double direction = 0;   ///< rad, of the force, polar angle in the sector's frame
  bool parabolic = true;  ///< density 3/4 (1 - x^2) over x in [-1, 1]; else uniform
  double z_low = 0, z_high = 0;  ///< m, of a solid ring: uniform between them
};

/// The part of the load that lies on the sector's own outside.
[[nodiscard]] NodalLoad on_outside(const ArcLoad& arc, const TraceGrid& outside);

}  // namespace annulus::fem
