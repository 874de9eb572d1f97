#pragma once

#include <memory>

#include "app/model/lumped_model.h"
#include "app/systems/two_k_v/two_k_v_model.h"

namespace annulus::app {

/// The reducer on these stiffnesses. Throws InputError for dimensions that are not possible.
[[nodiscard]] std::unique_ptr<LumpedModel> two_k_v_lumped_model(const Scene& scene, TwoKVTables tables);
/// The ways of the cost study to it.
[[nodiscard]] ModelWays two_k_v_ways(const Scene& scene, const TwoKVTables& tables);

}  // namespace annulus::app
