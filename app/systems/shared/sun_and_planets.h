#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/report/drawings/transverse_section.h"
#include "app/scene/scene.h"
#include "geometry/gear_pair.h"

namespace annulus::app {

/// Sun and planets of any stage: polar angle of each planet and the angle of its tooth 0, rad.
void add_sun_and_planets(TransverseSection& section, const Scene& scene, const geometry::GearPair& sun_mesh,
                         double sun_angle, const std::vector<std::pair<double, double>>& planets,
                         const std::string& id);

}  // namespace annulus::app
