#pragma once

#include <vector>

#include "app/plan/cost_plan.h"
#include "app/scene/scene.h"

namespace annulus::app {

/// What the studies of a scene will take, without computing anything elastic.
[[nodiscard]] std::vector<StudyPlan> plan_studies(const Scene& scene);

}  // namespace annulus::app
