#pragma once

#include <optional>
#include <vector>

#include "app/scene/scene.h"
#include "app/scene/scene_schema.h"
#include "app/systems/shared/space_input.h"

/// Bearings in their places, loads that are no torques, gravity: tables of systems whose bodies tilt.
namespace annulus::app {

/// What a kind of gear system has in space.
struct KindInSpace {
  struct OfBody {
    const char* name;
    dynamics::StageBody::Kind body;
    double GravityInput::*centre_of_mass;
    std::optional<double> TiltInertiaInput::*tilt_inertia;
  };
  /// With a carrier bodies stand on each other, planets have numbers, and x and y may turn with the carrier.
  enum class Frames { housing, housing_and_carrier };
  std::vector<OfBody> bodies;
  Frames frames = Frames::housing;
};

/// [[bearing]], [[load]], [gravity], [tilt_inertia], and a key of [dynamics] at the end.
[[nodiscard]] std::vector<Table> space_tables(const KindInSpace& system);
/// Names, lengths of lists, and bodies that fit each other.
void check_space(Scene& scene, std::vector<Problem>& problems);

}  // namespace annulus::app
