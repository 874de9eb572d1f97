#pragma once

#include <cstddef>
#include <string>

#include "app/scene/scene.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::app {

class GearSystem;

/// Where a variant stands in GearSystem::variants(). An empty name is the only one. Throws InputError for a name that
/// is not there, and for none of several.
[[nodiscard]] std::size_t variant_number(const GearSystem& system, const std::string& variant);

/// The lumped system of a variant (a ring of a planetary stage; empty where there is one) at its operating point.
/// Solves the stiffness tables that it stands on, or reads them from the cache; writes nothing else. Throws InputError
/// for a scene without [dynamics] or without such a variant, and what solving throws.
[[nodiscard]] dynamics::LumpedCase solved_case(const Scene& scene, const std::string& variant, int threads);

}  // namespace annulus::app
