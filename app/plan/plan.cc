#include "app/plan/plan.h"

namespace annulus::app {

long Plan::contact_problems() const {
  long count = 0;
  for (const auto& mesh : meshes) {
    if (!mesh.computed()) continue;
    count +=
        (static_cast<long>(mesh.positions) * mesh.problem->phases + 1) * static_cast<long>(mesh.problem->loads.size());
  }
  return count;
}

}  // namespace annulus::app
