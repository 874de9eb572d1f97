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
  /// Max |F| / mean mesh force over the window (peaks refined between the samples), on whichever flanks it acts.
  Figure dynamic_factor_max;
  double dynamic_factor_min = 0;  ///< min F / mean mesh force, negative on back flanks
  double mean_force = 0;          ///< N, negative on back flanks
  Figure contact_loss;            ///< fraction of the time without contact
  double back_flanks = 0;         ///< fraction of the time in which back flanks carry the load
};

/// Results of the meshes first ... first + count - 1 of a steady state. `mean_force`: N, reference of the factors.
[[nodiscard]] std::vector<BranchResult> branch_results(const SteadyResponse& found, Eigen::Index first,
                                                       Eigen::Index count, double mean_force);
/// Load sharing of the same meshes. `quasi_static_force`: N, meshes x positions.
[[nodiscard]] LoadSharing load_sharing(const SteadyResponse& found, Eigen::Index first, Eigen::Index count,
                                       const Eigen::MatrixXd& quasi_static_force);

/// Largest dynamic factor of the branches, and their largest contact loss.
[[nodiscard]] Figure largest_dynamic_factor(const std::vector<BranchResult>& branches);
[[nodiscard]] Figure largest_contact_loss(const std::vector<BranchResult>& branches);

/// Largest N |F_n| / sum |F| over all columns in which a branch carries load; `force` (N) has one row per branch. Not
/// known where none does.
[[nodiscard]] double load_sharing_instantaneous(const Eigen::Ref<const Eigen::MatrixXd>& force);
/// N F_n / sum |F| over time, one row per branch; not known where no branch carries load.
[[nodiscard]] Eigen::MatrixXd load_sharing_over_time(const Eigen::Ref<const Eigen::MatrixXd>& force);

}  // namespace annulus::dynamics
