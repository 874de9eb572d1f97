#pragma once

#include "fem/contact/flank_contact.h"
#include "fem/problem/material.h"

namespace annulus::fem {

/// Half-width of a line contact after Hertz, b = sqrt(4 F' / (pi E* kappa)), E* = MeshMaterials::contact_modulus
/// [Johnson1985, sec. 4.2]. F' in N/m, kappa the relative curvature in 1/m.
[[nodiscard]] double hertz_half_width(double line_load, double relative_curvature, const MeshMaterials& materials);
/// Hertz half-width (m) if a pair that touches at pinion roll `roll` (m) took a whole line load (N/m).
[[nodiscard]] double hertz_half_width(const FlankContact& flanks, double roll, double line_load,
                                      const MeshMaterials& materials);

}  // namespace annulus::fem
