#pragma once

#include <string>

#include "app/scene/scene.h"
#include "geometry/gear.h"

/// Checks of bodies that are meshed, shared by the kinds of gear systems.
namespace annulus::app {

/// Relative rounding of diameters that come from sums.
inline constexpr double diameter_rounding = 1e-9;

/// Least thickness of a rim behind the root, m.
[[nodiscard]] double least_rim(const Scene& scene);
/// "a computed mesh needs 1.2 mm = 0.3 modules of rim behind the root"
[[nodiscard]] std::string rim_rule(const Scene& scene);
/// `length` (m) with its unit: "663.6 mm".
[[nodiscard]] std::string length_mm(double length);

/// Throws GeometryError, starting with the key in [`table`], where the bore leaves the gear no rim. Without bore
/// nothing is checked.
void check_bore(const Scene& scene, const char* table, const HubGearInput& input, const geometry::Gear& gear);

}  // namespace annulus::app
