#include "fem/resolution.h"

#include <algorithm>
#include <cmath>

#include "geometry/profile.h"

namespace annulus::fem {

BodyResolution contact_resolution(const geometry::Gear& gear, double half_width, double accuracy, Level level) {
  const geometry::ToothProfile profile(gear);
  const double base = gear.base_radius();
  const double tip = profile.roll_length_tip(), form = profile.roll_length_form();
  const double flank = std::abs(tip * tip - form * form) / (2 * base);
  // Quadratic elements: the near field converges with the square of the cell size (measured by the benchmarks).
  const double refine = std::sqrt(std::clamp(0.01 / accuracy, 0.25, 100.0)) * (level == Level::check ? 1 / level_ratio : 1);
  const double cell = half_width / 6 / refine;
  const double thickness = gear.tooth_thickness(gear.reference_radius());

  BodyResolution r;
  auto& s = r.section;
  s.flank_cells = std::clamp(static_cast<int>(std::ceil(flank / cell)), 8, 400);
  // Layers grow by about a third from either flank to the middle of the tooth.
  const double growth = 1 + 0.3 / refine;
  const double layers = 2 * std::log(1 + (growth - 1) * thickness / 2 / cell) / std::log(growth);
  s.thickness_cells = std::clamp(2 * static_cast<int>(std::ceil(layers / 2)), 4, 80);
  s.flank_layer = std::clamp(cell * s.thickness_cells / thickness, 0.02, 1.0);
  s.fillet_cells = 2 * std::max(1, static_cast<int>(std::lround(3 * refine)));
  s.root_cells = std::max(1, static_cast<int>(std::lround(2 * refine)));
  s.rim_cells = std::max(2, static_cast<int>(std::lround(6 * refine)));
  return r;
}

BodyResolution solid_resolution(Level level) {
  BodyResolution r;
  auto& s = r.section;
  if (level == Level::reported) {
    s = {10, 2, 6, 1, 3, 0.8};
    r.face_cells = 8;
    r.sleeve_cells = 3;
  } else {
    s = {7, 2, 4, 1, 2, 1.0};
    r.face_cells = 5;
    r.sleeve_cells = 2;
  }
  return r;
}

}  // namespace annulus::fem
