#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/plan/plan.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"

/// What a scene says of itself before anything is computed, the same for every kind of gear system.
namespace annulus::app {

/// Assumed inputs, phases of errors that nobody stated, and accuracies that are not expected to be reached. `plan`: its
/// inputs, meshes and cost.
[[nodiscard]] std::vector<Warning> common_warnings(const Scene& scene, const Plan& plan);

/// Errors whose phases nobody stated, where no samples of them are drawn.
void warn_of_arbitrary_phases(std::vector<Warning>& list, const Scene& scene, const std::string& remedy);

/// A tip that passes the root of its mate nearer than a tenth of a module. `gears`: names of pinion and wheel.
void warn_of_clearance(std::vector<Warning>& list, const geometry::GearPair& pair,
                       const std::pair<const char*, const char*>& gears, const std::string& mesh);
/// A gear of that name whose rack corner cut into the involute.
void warn_of_undercut(std::vector<Warning>& list, const geometry::Gear& gear, const std::string& name);
/// Measured flanks on one side of the teeth only, or that leave out more than a tenth of the part that touches; their
/// ends are continued there.
void warn_of_measured_flanks(std::vector<Warning>& list, const geometry::GearPair& pair,
                             const std::pair<const char*, const char*>& gears, const std::string& mesh);
/// A half backlash of the dynamics (m) that is larger than half of what the geometry leaves.
void warn_of_backlash(std::vector<Warning>& list, double half_backlash, const geometry::GearPair& pair,
                      const std::string& mesh);

}  // namespace annulus::app
