#pragma once

#include <functional>

#include "app/systems/planetary/planetary_run.h"

namespace annulus::test {

/// A solution of the right form with made-up numbers: everything that a finite-element solution of this model may tell
/// (pins, load over the face width, pressure, stress) without solving anything. The largest face load factor, 1.5, and
/// the largest stresses occur at phase 0 of ring tooth 0.
[[nodiscard]] fem::LoadedMeshResult made_up_solution(const app::MeshModel& model);

/// A run of a scene with a made-up solution of every computed mesh, `phases` positions per mesh cycle, no dynamics.
/// `change`: what is changed in every mesh result.
[[nodiscard]] app::RunResult made_up_run(const app::Scene& scene, int phases,
                                         const std::function<void(app::MeshResult&)>& change = {});

}  // namespace annulus::test
