#pragma once

#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

/// Completes a scene whose values are all of the right type and range (lists of one value per planet), and checks the
/// rules between keys. Problems are appended, never thrown.
void complete_and_check(Scene& scene, std::vector<Problem>& problems);

/// The rules between the keys of a 2K-V stage (two_k_v_checks.cc), part of complete_and_check.
void check_two_k_v_keys(Scene& scene, std::vector<Problem>& problems);

/// The rules between the keys of [[sweep]], [monte_carlo] and [sensitivity], part of complete_and_check. Whether each
/// changed scene is a good one is left to check_studies (studies.h).
void check_study_keys(const Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
