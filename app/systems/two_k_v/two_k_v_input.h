#pragma once

#include <optional>

#include "app/scene/scene.h"
#include "dynamics/systems/two_k_v/arc_tooth.h"

namespace annulus::app {

/// A crank shaft of a 2K-V stage: its planet sits on one end, its eccentrics carry the arc gears.
struct CrankInput {
  std::optional<double> inertia, shaft, bearing;  ///< kg m^2; N m/rad planet to eccentrics; N/m in the carrier
  double angle = 0;                               ///< of the eccentrics at time 0, rad
  std::optional<double> shaft_damping, bearing_damping;
};

/// The arc-tooth gears of a 2K-V stage and the pins of the housing.
struct ArcGearInput {
  int count = 0, pins = 0;
  double eccentricity = 0;
  std::optional<double> pin_circle_diameter, pin_diameter, arc_radius, width;
  double clearance = 0;
  dynamics::LineApproach approach = dynamics::LineApproach::handbook;
  std::optional<double> mass, inertia, bearing;  ///< of one; N/m on one eccentric
  std::optional<double> bearing_damping;
};

struct InputShaftInput {
  std::optional<double> inertia, shaft;  ///< kg m^2; N m/rad to the sun
  double support = 0;                    ///< N m/rad; 0: free
  std::optional<double> damping;
};

struct OutputInput {
  double torque = 0, speed = 0;
  std::optional<double> inertia;
  double support = 0;  ///< N m/rad; `rigid`: fixed
  std::optional<double> damping;
};

/// Whether a prescribed stiffness is also computed.
enum class Compare { none, computed };

/// What the scene of a 2K-V reducer has of its own, besides sun and planets (sun_planet_input.h).
struct TwoKVInput {
  CrankInput crank;
  ArcGearInput arc_gear;
  MeshInput arc_pins;
  Compare compare_sun_planet = Compare::none, compare_arc_pins = Compare::none;
  InputShaftInput input;
  OutputInput output;
};

[[nodiscard]] inline TwoKVInput& two_k_v(Scene& scene) { return scene.own<TwoKVInput>(); }
[[nodiscard]] inline const TwoKVInput& two_k_v(const Scene& scene) { return scene.own<TwoKVInput>(); }

}  // namespace annulus::app
