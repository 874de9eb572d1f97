#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dynamics/steady_state/steady_response.h"

namespace annulus::dynamics {

/// A system as a function of one input.
using LumpedFamily = std::function<LumpedCase(double input)>;

/// A periodic motion on a branch.
struct BranchPoint {
  double input = 0;
  double largest_force = 0;  ///< N, of any mesh
  double contact_loss = 0;   ///< share of the time without contact, the largest of any mesh
  double multiplier = 0;     ///< largest modulus of a Floquet multiplier of one period
  bool stable = false;
};

/// Where the stability of a branch changes.
struct BranchEvent {
  enum class Kind {
    fold,             ///< the branch turns back: motions jump to another one
    period_doubling,  ///< a multiplier passes -1: a motion of twice the period branches off
    neimark_sacker,   ///< a pair of complex multipliers passes the unit circle: a second frequency appears
    branching         ///< a multiplier passes +1 without a fold: another motion of the same period crosses
  };
  Kind kind = Kind::fold;
  double input = 0, error = 0;  ///< error: interpolation along the branch; of folds see branches_between()
  std::size_t before = 0;       ///< the point in front of it
};
[[nodiscard]] const char* to_string(BranchEvent::Kind kind);

struct Branch {
  std::vector<BranchPoint> points{};  ///< in their order along the branch
  std::vector<BranchEvent> events{};
  std::string end{};  ///< why it ends within the range; empty: it leaves the range
};

struct BranchOptions {
  double from = 0, to = 0;     ///< of the input; the branch begins at `from`
  int samples_per_cycle = 64;  ///< a multiple of 8
  int max_points = 1000;
  double max_step = 0.02;  ///< along the branch: of the range of the input, and of five static deflections
};

/// Follows the periodic motions of a family of systems from one end of a range by pseudo-arclength continuation of the
/// harmonic balance (periodic_response) [KrackGross2019, ch. 4], through folds, stable or not, until the branch leaves
/// the range. Stability follows from Floquet multipliers (floquet.h). Folds lie where the input turns, by a parabola
/// through three points close to each other; other events where a multiplier passes the unit circle.
///
/// The number of meshes, the names of the DOFs and the period in mesh cycles must not change. Throws InputError where
/// they do, for unusable options and what the family throws, SolverError where no motion is found at `from`. No system
/// beyond the range is asked for.
[[nodiscard]] Branch trace_branch(const LumpedFamily& family, const BranchOptions& options);

/// The branches that begin at either end of the range, one where they are the same. Folds have the difference to half
/// the samples in their errors, not known where these have no such fold. Throws SolverError where no motion is found at
/// either end.
[[nodiscard]] std::vector<Branch> branches_between(const LumpedFamily& family, const BranchOptions& options);

}  // namespace annulus::dynamics
