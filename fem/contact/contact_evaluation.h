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
/// Where the unknowns of the floating bodies stand among those of a position, behind the contacts: those of the wheel,
/// then those of the pinion.
struct FloatingUnknowns {
  const SupportRow* row;
  Eigen::Index force, motion;  ///< the first ones
  double radius;               ///< m, by which rotations are displacements
};
[[nodiscard]] std::vector<FloatingUnknowns> floating_unknowns(const ContactBodies& bodies, Eigen::Index contacts);
/// Motions of a floating body, as its resultants are ordered (m, rad).
[[nodiscard]] Eigen::VectorXd support_motion(const FloatingUnknowns& body, const ComplementaritySolution& solution);
/// Forces of its row, those that are applied included.
[[nodiscard]] Eigen::VectorXd row_forces(const ContactBodies& bodies, const ToothPairs& setup,
                                         const FloatingUnknowns& body, const ComplementaritySolution& solution);
/// Where tooth 0 of the pinion stands in the frame of the solve, rad.
[[nodiscard]] double pinion_angle(const ContactBodies& bodies, const ToothPairs& setup);
/// Forces that the other mesh of a planet on rollers applies to it, as the last ones of its row, N.
[[nodiscard]] Eigen::VectorXd applied_forces(const ContactBodies& bodies, const ToothPairs& setup);
/// Final forces at the ports of both bodies and at the supports, during mesh cycle `cycle`.
[[nodiscard]] ContactForces port_forces(const ContactBodies& bodies, const ToothPairs& setup, int cycle,
                                        const ComplementaritySolution& solution);

}  // namespace annulus::fem
