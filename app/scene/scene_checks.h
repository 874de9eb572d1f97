#pragma once

#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

/// Completes a scene whose values are all of the right type and range (conditional defaults, lists of one value per
/// planet, derived values), and checks the rules between keys. Problems are appended, never thrown.
void complete_and_check(Scene& scene, std::vector<Problem>& problems);

/// The values of [[sweep]], [[grid]], [monte_carlo], [sensitivity] and [optimise], part of complete_and_check. Whether
/// each changed scene is a good one is left to check_studies (studies.h).
void check_study_keys(const Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
