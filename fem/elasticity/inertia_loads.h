#pragma once

#include <vector>

#include "fem/elasticity/nodal_load.h"
#include "fem/elasticity/sector_model.h"

namespace annulus::fem {

/// Smooth motions of a sector whose inertia stands for that of all its mass: polynomials over the section (total degree
/// `section_order` in x and y, every component) times Legendre polynomials over the axial length.
struct MotionOrder {
  int section = 2;  ///< 1 holds the rigid motions of the section
  int axial = 3;    ///< solid bodies only
};

/// The inertia loads M psi_a of these motions, made orthonormal: psi_a^T M psi_b is 1 for a = b, else 0. M is the
/// consistent mass of what is not held, `width` times (in the plane, else 1) that of the model, which has its
/// nodal_mass. Units: a motion has kg^-1/2, its load kg^1/2.
///
/// As displacement functionals they give the amplitudes y_a = psi_a^T M u of the motions in u; sum y_a^2 <= u^T M u,
/// and the sum grows with the orders.
[[nodiscard]] std::vector<NodalLoad> inertia_loads(const SectorModel& model, double width, const MotionOrder& order);

}  // namespace annulus::fem
