#include "fem/problem_check.h"

#include "core/errors.h"

namespace annulus::fem {

void check_problem(const LoadedMeshProblem& problem, Rung rung) {
  if (problem.loads.empty() || problem.phases < 2) throw InputError("a loaded mesh needs a load and two phases");
  for (std::size_t i = 0; i < problem.loads.size(); ++i)
    if (!(problem.loads[i] > (i > 0 ? problem.loads[i - 1] : 0.0)))
      throw InputError("the loads of a stiffness table have to be positive and strictly increasing");
  if (!problem.pair.internal() && !std::holds_alternative<OutsideHeld>(problem.structure))
    throw InputError("a ring structure belongs to the ring mesh");
  if (rung == Rung::solid || rung == Rung::resolved_solid) return;
  for (const auto* gear : {&problem.pair.planet(), &problem.pair.wheel()}) {
    if (gear->parameters().lead_crowning != 0 || gear->parameters().lead_slope != 0)
      throw InputError("lead modifications need a load distribution over the face width: use rung = \"solid\"");
    if (gear->helix_angle() != 0) throw InputError("helical gears need solid bodies: use rung = \"solid\"");
  }
  if (problem.misalignment != 0)
    throw InputError("misalignment needs a load distribution over the face width: use rung = \"solid\"");
}

}  // namespace annulus::fem
