#pragma once

#include <optional>
#include <vector>

#include "fem/levels/error_estimate.h"
#include "fem/loaded_mesh.h"
#include "tests/verification_record.h"

namespace annulus::tests {

inline constexpr double nominal_load = 59460;     ///< N, normal force of one mesh
inline constexpr double ring_outside = 331.8e-3;  ///< m, outside radius of the ring
inline constexpr double pin_diameter = 15.5e-3;   ///< m

/// Ring teeth by which equally spaced planets stand ahead of the first, in the paper's ring.
std::vector<double> equal_places(int planets);

/// The gear meshes of the ring-type paper; `phases` positions per mesh cycle.
fem::LoadedMeshProblem ring_mesh(const fem::RingStructure& structure, int phases,
                                 std::vector<double> loads = {nominal_load});
fem::LoadedMeshProblem sun_mesh(int phases, std::vector<double> loads = {nominal_load});
/// The same with a modified lead of the planet, m.
fem::LoadedMeshProblem with_planet_lead(fem::LoadedMeshProblem problem, double crowning, double slope);
/// The same with helical teeth (planet and ring right-handed for a positive angle, rad; a sun left-handed), at the
/// centre distance without backlash.
fem::LoadedMeshProblem with_helix(fem::LoadedMeshProblem problem, double helix_angle);
/// What equal pins on the paper's ring feel together. Seen from the carrier the planet turns clockwise: at the pitch
/// point it presses the ring outwards and clockwise.
struct PinResultant {
  double force = 0, direction = 0;  ///< N; rad, from the clockwise tangent at the pitch point outwards
  double torque = 0;  ///< N m, clockwise; of a parabola over an arc of +- beta the lever arm is R (1 - beta^2 / 10)
};
PinResultant pin_resultant(const fem::LoadedPosition& position, double first_pin_angle);
/// Pins in equal spacing.
fem::PinHeld paper_pins(int pins, double first_pin_angle);

fem::LoadedMeshResult solve_plane(const fem::LoadedMeshProblem& problem, int level = 1, int threads = 2);
fem::LoadedMeshResult solve_solid(const fem::LoadedMeshProblem& problem);

/// What has to hold at every position of unmodified flanks, whatever the structure: balances, load shares, no
/// penetration.
void check_positions(const std::vector<fem::LoadedPosition>& positions, test::Verification* record = nullptr);
/// The same of a whole result, and closure.
void check_invariants(const fem::LoadedMeshResult& result, test::Verification* record = nullptr);
inline constexpr const char* invariants_reference =
    "statics: contact forces x base radius = torque; work of the load = strain energy; Maxwell and Betti; no tension, "
    "no "
    "penetration; the cycle closes";
/// Every figure of two results bit by bit.
void check_identical(const fem::LoadedMeshResult& a, const fem::LoadedMeshResult& b);
/// Largest relative difference of the transmission errors of two results at the same positions.
double largest_lte_difference(const fem::LoadedMeshResult& a, const fem::LoadedMeshResult& b);

/// Estimated relative error without what the model leaves out: of two solutions of the same model.
inline double numeric_error(const StiffnessEntry& entry) { return entry.error_relative - entry.error_parts.model; }
/// Estimated error of the closed form alone: the plane finite elements share the plane strain.
inline double formula_error(const fem::LoadedMeshProblem& problem, const StiffnessEntry& entry) {
  return entry.error_relative - fem::plane_strain_error(problem);
}

}  // namespace annulus::tests
