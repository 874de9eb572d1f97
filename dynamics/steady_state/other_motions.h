#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/not_known.h"
#include "dynamics/time_integration/integrate.h"

namespace annulus::dynamics {

struct SteadyProblem;
struct SteadyOutcome;
enum class StiffnessCourse;

/// How other motions of the same system are looked for: backlash and load together may allow several.
struct MotionSearch {
  /// Random initial conditions. A motion to which a share s of them leads is missed with the probability (1 -
  /// s)^starts. 0: none are tried.
  int starts = 0;
  int threads = 1;
  double size = 3;  ///< static mesh deflections, see RandomStarts
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
  int wanted = 0;                   ///< random initial conditions that were asked for
  int starts = 0;                   ///< those that were tried; 0: none
  std::string not_tried{};          ///< why none were, although backlash is within reach
  std::vector<FoundMotion> list{};  ///< the largest force first; empty where none were tried
  int undecided = 0;                ///< starts whose vibrations had not died out in the end, or could not be integrated
};

/// Stable motions of a system whose excitation repeats after the period of the problem, with the state of each at the
/// start of a period.
struct StableMotions {
  FoundMotions found;
  std::vector<SystemState> states{};  ///< in the order of found.list, at time 0
};
/// Follows the motion that `present` begins with, moved by a hundredth of the static deflection, then the random
/// starts, in time until 12 periods of the excitation repeat twice, or for 288 periods, after which other periods below
/// 12 are looked for. Two motions are the same when forces (relative to the largest) and loss of contact of their
/// meshes differ by less than 2 %; meshes may change places. A motion that does not repeat is irregular where two of
/// its states that are close to each other part; all irregular motions count as one, whose largest force is that of the
/// last third of the time. Others are followed as long again, and are undecided where that does not help. `taken` marks
/// the motion to which `present` leads; a steady one is a motion in any case. The integrator needs its absolute
/// tolerance.
[[nodiscard]] StableMotions stable_motions(const LumpedSystem& system, const SteadyProblem& problem,
                                           const SteadyOutcome& present, const IntegratorOptions& integrator,
                                           const MotionSearch& search);

/// As many of the wanted starts as `usual_search_s` of processor time allow by the cost law, which is the same on every
/// machine; 0 where these are fewer than four. `longest_search_s` holds by counted evaluations: after the first two
/// no more are tried than can be decided in this time, but for four, and one that takes more than its share is
/// undecided.
[[nodiscard]] int affordable_starts(const LumpedSystem& system, const SteadyProblem& problem,
                                    const IntegratorOptions& integrator, int wanted, StiffnessCourse course);
/// Periods of the excitation until a start is decided, on average: from 48 to 576.
inline constexpr int periods_of_a_start = 80, longest_start = 576;
inline constexpr double usual_search_s = 10, longest_search_s = 30;

/// Longest period, mesh cycles, for which motions are looked for.
inline constexpr int longest_searched_period = 200;

}  // namespace annulus::dynamics
