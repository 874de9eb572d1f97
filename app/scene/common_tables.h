#pragma once

#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::app {

/// Tables that every kind of gear system has, before and behind its own: the top level, [stage] and [material]; then
/// [dynamics] and the studies.
[[nodiscard]] std::vector<Table> first_common_tables();
[[nodiscard]] std::vector<Table> last_common_tables();

/// [[sweep]], [[grid]], [monte_carlo], [[monte_carlo.input]], [sensitivity], [optimise], [[optimise.variable]]
/// (study_tables.cc).
[[nodiscard]] std::vector<Table> study_tables();

}  // namespace annulus::app
