#pragma once

#include "fem/contact/complementarity.h"
#include "fem/contact/contact_forces.h"
#include "fem/contact/pressure_elements.h"
#include "fem/contact/support_row.h"
#include "fem/contact/tooth_pairs.h"
#include "fem/problem/loaded_mesh_result.h"

namespace annulus::fem {

/// Stiffness, shares, pressures, balances and supports of a solved position. Throws SolverError when the loaded
/// transmission error does not exceed the unloaded one.
[[nodiscard]] LoadedPosition evaluate(const ContactBodies& bodies, const ToothPairs& setup,
                                      const ComplementarityProblem& problem, const ComplementaritySolution& solution);
/// Motions of a wheel on supports, as its resultants are ordered (m, rad).
[[nodiscard]] Eigen::VectorXd support_motion(const ContactBodies& bodies, const ComplementaritySolution& solution);
/// Final forces at the ports of both bodies and at the supports, during mesh cycle `cycle`.
[[nodiscard]] ContactForces port_forces(const ContactBodies& bodies, const ToothPairs& setup, int cycle,
                                        const ComplementaritySolution& solution);

}  // namespace annulus::fem
