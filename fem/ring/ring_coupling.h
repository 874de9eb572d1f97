#pragma once

#include <Eigen/Core>

#include "core/ring_coupling.h"
#include "fem/elasticity/inertia_loads.h"
#include "fem/problem/loaded_mesh_problem.h"
#include "fem/ring/ring_modes.h"

namespace annulus::fem {

/// `plane_where_possible`: rings of constant section held over their full width in plane strain, others as solids.
enum class RingModel { plane_where_possible, solid };

/// What a ring of finite width differs from plane strain at most, relative. Bending of a narrow ring is in plane
/// stress, whose stiffness is smaller by 1 - nu^2 [TimoshenkoGoodier1970].
struct PlaneStrainBounds {
  double compliance = 0;  ///< nu^2 / (1 - nu^2)
  double frequency = 0;   ///< 1 - sqrt(1 - nu^2)
};
/// Zero where the ring is solved as a solid.
[[nodiscard]] PlaneStrainBounds plane_strain_bounds(const LoadedMeshProblem& problem,
                                                    RingModel model = RingModel::plane_where_possible);

struct RingCouplingSettings {
  RingModel model = RingModel::plane_where_possible;
  int level = 1;      ///< of resolution, 1 or finer; errors are estimated from the level and the motions before
  int degree = 2;     ///< polynomial degree of the elements
  int per_cycle = 1;  ///< ring positions per mesh cycle
  ModeLimits modes;
  MotionOrder motions;                         ///< of a sector's inertia, their section order at least 1
  int threads = 1;                             ///< changes the time, never the result
  std::shared_ptr<const ResultStore> store{};  ///< where tooth superelements are cached; may be null
};

struct SolvedRingCoupling {
  RingCoupling coupling;
  /// m/N, mean over ring positions and planets: what a mesh alone moves its own tooth, force and displacement spread
  /// over half the flank (no contact, no bending of the planet): the scale of the coupling.
  double own_compliance = 0;
  /// m/N, ring teeth x ring teeth: deflection at the flank of tooth i under a unit mesh force on tooth j, both along
  /// the line of action at the pitch point; supports that could lift off are held both ways. Symmetric, positive
  /// definite: its inverse is the stiffness matrix of the ring reduced to its teeth.
  Eigen::MatrixXd teeth_compliance{};
  // Estimated: of the discretisation, and the bounds of plane strain.
  double teeth_compliance_error = 0;    ///< m/N, largest of all entries
  double compliance_error = 0;          ///< m/N, largest of all entries
  double frequency_error_relative = 0;  ///< largest of the modes of the result
  long unknowns = 0;                    ///< DOFs of the sector
  int condensed_teeth = 0, reused_teeth = 0;
};

/// Compliance between the ring meshes of the planets, and the modes of the ring. `teeth_ahead` are the ring teeth by
/// which each planet stands ahead of the first (PlanetarySet::ring_teeth_ahead), 0 for the first.
///
/// Of the problem, only pair, material, face width, outside radius and structure are used.
///
/// A mesh force between two whole positions lies on the four
/// teeth around it with the weights of cubic interpolation: the far field of teeth that share it.
///
/// Supports that can lift off make the ring non-linear. Off the diagonal stands the tangent compliance while all
/// meshes carry `load`, which is symmetric. The diagonal is chosen so that under equal loads
///
///     sum_m compliance(n, m) load = deflection lost at n when all are loaded - when n alone is
///
/// holds exactly; without clearance it is the difference of the mesh's own tangent compliance in both states. The
/// mesh's own compliance alone is in its stiffness table. With other supports the diagonal is zero.
///
/// Throws InputError when the problem is not a ring mesh or an option is out of range, SolverError when the supports do
/// not settle.
[[nodiscard]] SolvedRingCoupling solve_ring_coupling(const LoadedMeshProblem& problem,
                                                     const std::vector<double>& teeth_ahead, double load,
                                                     const RingCouplingSettings& settings);

/// How a unit mesh force of a planet at ring position coordinate `position` (see PlanetarySet::ring_tooth_offset) lies
/// on the teeth of the ring, in the frame of the solve, whose teeth count backwards: one value per tooth.
[[nodiscard]] Eigen::VectorXd mesh_force_on_teeth(double position, int teeth);

}  // namespace annulus::fem
