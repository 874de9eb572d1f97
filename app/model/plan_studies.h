#pragma once

#include <vector>

#include "app/plan/cost_plan.h"
#include "app/scene/scene.h"

namespace annulus::app {

class GearSystem;

/// What the studies of a scene will take, without computing anything elastic.
[[nodiscard]] std::vector<StudyPlan> plan_studies(const Scene& scene);
/// The same where the responses of the system are known.
[[nodiscard]] std::vector<StudyPlan> plan_studies(const GearSystem& system,
                                                  const std::vector<PlannedResponse>& responses);

}  // namespace annulus::app
