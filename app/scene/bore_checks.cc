#include "app/scene/bore_checks.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "core/units.h"
#include "geometry/sector_mesh.h"

namespace annulus::app {

std::string length_mm(double length) { return to_text(length / units::mm, 7) + " mm"; }

double least_rim(const Scene& scene) { return geometry::min_circle_distance * scene.stage.module; }

std::string rim_rule(const Scene& scene) {
  return fmt::format("a computed mesh needs {} = {} modules of rim behind the root", length_mm(least_rim(scene)),
                     geometry::min_circle_distance);
}

void check_bore(const Scene& scene, const char* table, const HubGearInput& input, const geometry::Gear& gear) {
  if (!input.bore_diameter) return;
  const double most = 2 * (gear.root_radius() - least_rim(scene));
  if (*input.bore_diameter <= most * (1 + diameter_rounding)) return;
  throw GeometryError(fmt::format("{}.bore_diameter_mm = {}: must be in range: 0 < value <= {}; {}", table,
                                  to_text(*input.bore_diameter / units::mm), length_mm(most), rim_rule(scene)));
}

}  // namespace annulus::app
