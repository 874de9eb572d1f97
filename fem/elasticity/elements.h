#pragma once

#include "fem/elasticity/sector_model.h"

namespace annulus::fem {

/// What annulus lets deal.II do, in a library of its own that is loaded when it is needed.
struct Elements {
  /// See make_sector_model.
  SectorModel (*sector_model)(const geometry::Mesh& mesh, const geometry::ToothProfile& profile, double support_radius,
                              const Material& material, const SectorModelOptions& options);
};

}  // namespace annulus::fem
