#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/scene/key_checks.h"
#include "geometry/gear.h"

namespace annulus::app {

/// A gear whose profile shift may follow from others, or from what a drawing states.
struct ShiftedGear {
  std::string table;  ///< of its keys: "sun"
  GearInput* gear = nullptr;
  geometry::GearKind kind = geometry::GearKind::external;
  GearInput* mate = nullptr;  ///< an external gear, whose shift it may follow from
  std::string mate_table{}, ring{};
};

/// Gives every gear its profile shift (profile_shift_from), those first that need no mate, and internal gears without a
/// tip diameter a tip circle that ends above the mate's root fillet. Values that lead to no gear become problems.
/// Centre distances have to be known where they are needed.
void resolve_profile_shifts(Scene& scene, std::vector<Problem>& problems, const std::vector<ShiftedGear>& gears);

}  // namespace annulus::app
