#pragma once

#include <optional>
#include <string>

#include "app/scene/scene.h"

namespace annulus::app {

struct TiltingBody {
  std::string name;               ///< that of its table
  std::optional<double> given{};  ///< kg m^2, tilt_inertia.<name>_kg_m2
  double mass = 0, inertia = 0;   ///< kg, kg m^2 about its axis
  double width = 0;               ///< m, of a cylinder in its stead
  double centre_of_mass = 0;      ///< m, z
};
/// Moment of inertia (kg m^2) about an axis across the body's own at z = 0: the given one, or that of a uniform
/// cylinder. Throws InputError, with place and key, where no body has it.
[[nodiscard]] double tilt_inertia(const Scene& scene, const TiltingBody& body);

}  // namespace annulus::app
