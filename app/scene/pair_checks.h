#pragma once

#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

/// Completes the scene of a helical pair (inertias, centre distance) and checks the rules between its keys. Problems
/// are appended, never thrown.
void complete_and_check_pair(Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
