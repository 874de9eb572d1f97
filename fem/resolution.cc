#include "fem/resolution.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/errors.h"
#include "geometry/profile.h"

namespace annulus::fem {

namespace {

double flank_length(const geometry::Gear& gear) {
  const geometry::ToothProfile profile(gear);
  const double tip = profile.roll_length_tip(), form = profile.roll_length_form();
  return std::abs(tip * tip - form * form) / (2 * gear.base_radius());  // s = rho^2 / (2 r_b)
}

/// Wanted cell size at a level, m. Bounded so that every level really differs from its neighbours, and so that light
/// loads, whose contact is narrow but counts for little of the deflection, start coarse and are refined only as far as
/// needed.
double cell_size(const geometry::Gear& gear, double half_width, int level) {
  const double flank = flank_length(gear);
  const double finest_first = flank / 120, coarsest_first = flank / 12;
  return std::clamp(half_width / 6, finest_first, coarsest_first) / std::pow(level_ratio, level - 1);
}

int flank_cells(const geometry::Gear& gear, double half_width, int level) {
  // The bound of the first level makes an exact count; do not let round-off add a cell.
  return static_cast<int>(std::ceil(flank_length(gear) / cell_size(gear, half_width, level) * (1 - 1e-12)));
}

}  // namespace

int last_contact_level(const geometry::Gear& gear, double half_width) {
  int level = 1;
  while (flank_cells(gear, half_width, level + 1) <= most_flank_cells) ++level;
  return level;
}

BodyResolution contact_resolution(const geometry::Gear& gear, double half_width, int level) {
  require(level <= last_contact_level(gear, half_width), "no such level of plane resolution");
  const double refine = std::pow(level_ratio, level - 1);
  const double cell = cell_size(gear, half_width, level);
  const double thickness = gear.tooth_thickness(gear.reference_radius());

  BodyResolution r;
  auto& s = r.section;
  s.flank_cells = flank_cells(gear, half_width, level);
  // Layers grow by about a third from either flank to the middle of the tooth.
  const double growth = 1 + 0.3 / refine;
  const double layers = 2 * std::log(1 + (growth - 1) * thickness / 2 / cell) / std::log(growth);
  s.thickness_cells = std::clamp(2 * static_cast<int>(std::ceil(layers / 2)), 4, 160);
  s.flank_layer = std::clamp(cell * s.thickness_cells / thickness, 0.02, 1.0);
  // A curved edge bulges by L^2 / (8 R) over its chord; under a fillet that must stay a small part of the thin first
  // layer, or the mapping folds the cell.
  const double radius = std::max(0.05, gear.parameters().root_fillet_factor) * gear.parameters().module;
  const double longest = std::sqrt(0.4 * radius * cell);
  const double by_curvature = 1.6 * radius / longest;  // a quarter turn
  s.fillet_cells = 2 * static_cast<int>(std::ceil(std::max(3 * refine, by_curvature / 2)));
  s.root_cells = std::max(1, static_cast<int>(std::lround(2 * refine)));
  s.rim_cells = std::max(2, static_cast<int>(std::lround(6 * refine)));
  return r;
}

BodyResolution solid_resolution(int level) {
  require(level >= 0 && level <= last_solid_level, "no such level of solid resolution");
  static const std::array<BodyResolution, last_solid_level + 1> levels = {{
      {{7, 2, 4, 1, 2, 1.0}, 5, 2},
      {{10, 2, 6, 1, 3, 0.8}, 8, 3},
      {{15, 4, 8, 1, 4, 0.8}, 12, 4},
  }};
  return levels[level];
}

}  // namespace annulus::fem
