#pragma once

#include <string>

#include "app/scene/scene.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::app {

/// The lumped system of a variant (a ring of a planetary stage; empty where there is one) at its operating point.
/// Solves the stiffness tables that it stands on, or reads them from the cache; writes nothing else. Throws InputError
/// for a scene without [dynamics] or without such a variant, and what solving throws.
[[nodiscard]] dynamics::LumpedCase solved_case(const Scene& scene, const std::string& variant, int threads);

}  // namespace annulus::app
