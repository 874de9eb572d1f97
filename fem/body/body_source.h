#pragma once

#include "fem/body/gear_body.h"
#include "fem/elasticity/sector_model.h"
#include "geometry/mesh.h"
#include "geometry/profile.h"

namespace annulus::fem {

/// What a body was condensed from.
struct BodySource {
  geometry::Mesh mesh;
  const geometry::ToothProfile* profile = nullptr;
  double support_radius = 0;
  SectorModelOptions options;
  OtherFlankLoads other_flank{};
};

}  // namespace annulus::fem
