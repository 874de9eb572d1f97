#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/figure.h"
#include "dynamics/steady_state/steady_response.h"

/// What the forces of meshes are judged by, the same for every kind of gear system.
namespace annulus::dynamics {

/// N |F_n| / sum |F|, its maximum over the branches n (planets) and over ... . Forces on back flanks count like those
/// on driving flanks. Not known where no branch ever carries any load.
struct LoadSharing {
  Figure instantaneous;  ///< ... every instant at which any branch carries load
  Figure averaged;       ///< ... every mesh cycle, the forces averaged over it first
  Figure quasi_static;   ///< ... every position, without inertia and damping
};

/// Results of one mesh, such as that of one planet with sun or ring.
struct BranchResult {
  /// K_γ K_V: max |F| / nominal force over the window (peaks refined between the samples), on whichever flanks it acts.
  Figure peak_factor;
  /// K_V: max |F| / |mean of F over the mesh cycle around that instant|. It contains no load sharing: the base
  /// load is that of [ISO6336-1], F_t K_A K_γ. In a window that does not repeat, the cycles at its ends are
  /// its first and its last whole one. Not known for a mesh that carries nothing.
  Figure dynamic_factor;
  double smallest_factor = 0;  ///< min F / nominal force, negative on back flanks
  double mean_force = 0;       ///< N, negative on back flanks
  Figure contact_loss;         ///< fraction of the time without contact
  double back_flanks = 0;      ///< fraction of the time in which back flanks carry the load
};

/// Results of the meshes first ... first + count - 1 of a steady state. `nominal_force`: N, reference of the peak
/// factor. `mesh_cycle`: of these meshes, in the mesh cycles by which the window is sampled.
[[nodiscard]] std::vector<BranchResult> branch_results(const SteadyResponse& found, Eigen::Index first,
                                                       Eigen::Index count, double nominal_force, double mesh_cycle = 1);
/// Load sharing of the same meshes. `quasi_static_force`: N, meshes x positions; `closer`: the same at closer,
/// equidistant positions around the highest of these (highest_shares). Between two positions a share may have a kink,
/// which no parabola meets.
[[nodiscard]] LoadSharing load_sharing(const SteadyResponse& found, Eigen::Index first, Eigen::Index count,
                                       const Eigen::MatrixXd& quasi_static_force,
                                       const std::vector<Eigen::MatrixXd>& closer = {});
/// Columns at which the largest share is higher than in both neighbours, the `most` highest first; the first and the
/// last column are neighbours.
[[nodiscard]] std::vector<Eigen::Index> highest_shares(const Eigen::MatrixXd& force, std::size_t most);

/// The branch in which a result is largest; those in which it is not known do not count. Throws InternalError without
/// branches.
[[nodiscard]] std::size_t worst_branch(const std::vector<BranchResult>& branches, Figure BranchResult::*result);
[[nodiscard]] Figure largest(const std::vector<BranchResult>& branches, Figure BranchResult::*result);

/// Largest N |F_n| / sum |F| over all columns in which a branch carries load; `force` (N) has one row per branch. Not
/// known where none does.
[[nodiscard]] double load_sharing_instantaneous(const Eigen::Ref<const Eigen::MatrixXd>& force);
/// N F_n / sum |F| over time, one row per branch; not known where no branch carries load.
[[nodiscard]] Eigen::MatrixXd load_sharing_over_time(const Eigen::Ref<const Eigen::MatrixXd>& force);

}  // namespace annulus::dynamics
