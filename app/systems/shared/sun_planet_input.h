#pragma once

#include "app/scene/scene.h"

namespace annulus::app {

/// A sun with planets and their mesh, which several kinds of gear systems have.
struct SunPlanetInput {
  HubGearInput sun, planet;
  MeshInput sun_planet;
};

[[nodiscard]] inline SunPlanetInput& sun_and_planets(Scene& scene) { return scene.own<SunPlanetInput>(); }
[[nodiscard]] inline const SunPlanetInput& sun_and_planets(const Scene& scene) { return scene.own<SunPlanetInput>(); }

}  // namespace annulus::app
