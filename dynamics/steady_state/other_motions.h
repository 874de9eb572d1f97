#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/not_known.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

struct SteadyProblem;

/// How other motions of the same system are looked for: backlash and load together may allow several.
struct MotionSearch {
  /// Random initial conditions. A motion to which a share s of them leads is missed with the probability (1 -
  /// s)^starts. 0: none are tried.
  int starts = 0;
  int threads = 1;
  /// Within this many static mesh deflections of the equilibrium in every DOF, with velocities as of a vibration of
  /// that size at the higher one of mesh frequency and mean natural frequency of a mesh by itself.
  double size = 3;
};

/// A stable steady motion.
struct FoundMotion {
  int period = 0;            ///< periods of the excitation after which it repeats, up to 12; 0: none, it is irregular
  double largest_force = 0;  ///< N, of any mesh
  double contact_loss = 0;   ///< share of the time without contact, the largest of any mesh
  int starts = 0;            ///< how many random initial conditions led to it
  bool taken = false;        ///< the results are those of this motion
};

struct FoundMotions {
  double reach = not_known;         ///< reach_of_backlash(); not known where motions were not looked for
  int starts = 0;                   ///< random initial conditions that were tried; 0: none
  std::string not_tried{};          ///< why none were, although backlash is within reach
  std::vector<FoundMotion> list{};  ///< the largest force first; empty where none were tried
  int undecided = 0;                ///< starts whose vibrations had not died out in the end, or could not be integrated
};

/// Bound of the vibration over the smallest static deflection of a mesh beyond its backlash, the largest of all meshes
/// with backlash; 0 without backlash, infinite where a mesh carries nothing at some time without any vibration, or
/// where no bound is found. The bound takes every harmonic of the forces that stiffness and errors exert at constant
/// approach at the natural frequencies of the system with mean stiffness from a third to three times its own. Mesh
/// vectors that move are taken at time 0. Near and above 1 teeth may lose contact, and several motions may exist.
[[nodiscard]] double reach_of_backlash(const LumpedSystem& system, const SteadyProblem& problem);
/// From this bound on other motions are looked for; spur pairs that have several reach it (test).
inline constexpr double within_reach = 0.5;

/// Stable motions of a system whose excitation repeats after the period of the problem, with the state of each at the
/// start of a period.
struct StableMotions {
  FoundMotions found;
  std::vector<SystemState> states{};  ///< in the order of found.list, at time 0
};
/// Follows `present` (a state at time 0 of a motion that is known, or the end of a motion that is not steady), moved by
/// a hundredth of the static deflection, then the random starts, in time until 12 periods of the excitation repeat
/// twice. Two motions are the same when forces (relative to the largest) and loss of contact of their meshes differ by
/// less than 2 %; meshes may change places. A motion that does not repeat is irregular where two of its states that are
/// close to each other part; all irregular motions count as one. Others are undecided. `taken` marks the motion to
/// which `present` leads; where it is `steady`, that is a motion in any case. The integrator needs its absolute
/// tolerance.
[[nodiscard]] StableMotions stable_motions(const LumpedSystem& system, const SteadyProblem& problem,
                                           const SystemState& present, bool steady, const IntegratorOptions& integrator,
                                           const MotionSearch& search);

/// Longest period, mesh cycles, for which motions are looked for.
inline constexpr int longest_searched_period = 200;

}  // namespace annulus::dynamics
