#pragma once

#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::app {

/// Checks the rules between keys that the schema declares (only_if, required_if, refused_if, together_with,
/// instead_of), and gives keys the defaults that hold under a condition. Problems are appended, never thrown; a rule
/// that depends on a refused value is left out.
void check_key_rules(const std::vector<Table>& tables, Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
