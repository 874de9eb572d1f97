#include "fem/elasticity/sector_model.h"

#include "core/loaded_library.h"
#include "fem/elasticity/elements.h"

namespace annulus::fem {

SectorModel make_sector_model(const geometry::Mesh& mesh, const geometry::ToothProfile& profile, double support_radius,
                              const Material& material, const SectorModelOptions& options) {
  static const auto& elements = *static_cast<const Elements*>(elements_library.table());
  return elements.sector_model(mesh, profile, support_radius, material, options);
}

}  // namespace annulus::fem
