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

/// Fractions of a length, from 0 to 1, in cells of `cell` that shrink towards both ends by `ratio` each, down to
/// `first` at 0 and `last` at 1.
std::vector<double> graded_fractions(double length, double cell, double ratio, double first, double last) {
  const auto shrinking = [&](double smallest) {
    std::vector<double> sizes;
    for (double size = smallest; size < cell; size *= ratio) sizes.push_back(size);
    return sizes;
  };
  std::vector<double> sizes = shrinking(first);
  std::vector<double> end = shrinking(last);
  double used = 0;
  for (const auto* part : {&sizes, &end})
    for (const double size : *part) used += size;
  const int uniform = std::max(1, static_cast<int>(std::ceil((length - used) / cell)));
  sizes.insert(sizes.end(), uniform, std::max(length - used, cell) / uniform);
  sizes.insert(sizes.end(), end.rbegin(), end.rend());
  std::vector<double> fractions = {0};
  for (const double size : sizes) fractions.push_back(fractions.back() + size);
  for (double& f : fractions) f /= fractions.back();
  fractions.back() = 1;
  return fractions;
}

}  // namespace

BodyResolution plane_resolution(const geometry::Gear& gear, int level) {
  require(level >= 0 && level <= last_plane_level, "no such level of plane resolution");
  const double refine = std::pow(level_ratio, level - 1);
  const double length = flank_length(gear), thickness = gear.tooth_thickness(gear.reference_radius());
  const double cell = length / (20 * refine), at_tip = cell / 30, at_form = cell / 6;

  BodyResolution r;
  auto& s = r.section;
  s.flank_fractions = graded_fractions(length, cell, 1 + 0.2 / refine, at_form, at_tip);
  // The first layer under the flank is as thin as the shortest cell along it; layers grow from either flank to the
  // middle of the tooth.
  const double growth = 1 + 0.35 / refine;
  const double layers = 2 * std::log(1 + (growth - 1) * thickness / 2 / at_tip) / std::log(growth);
  s.thickness_cells = 2 * static_cast<int>(std::ceil(layers / 2));
  s.flank_layer = std::clamp(at_tip * s.thickness_cells / thickness, geometry::min_flank_layer, 1.0);
  // A curved edge bulges by L^2 / (8 R) over its chord; under a fillet that must stay a small part of the thin first
  // layer, or the mapping folds the cell.
  const double radius = std::max(0.05, gear.parameters().root_fillet_factor) * gear.parameters().module;
  const double longest = std::sqrt(0.4 * radius * at_tip);
  const double by_curvature = 1.6 * radius / longest;  // a quarter turn
  s.fillet_cells = 2 * static_cast<int>(std::ceil(std::max(3 * refine, by_curvature / 2)));
  s.root_cells = std::max(1, static_cast<int>(std::lround(2 * refine)));
  // They grow from the fillets on: fewer would start too thick for the stress in the root.
  s.rim_cells = std::max(4, static_cast<int>(std::lround(10 * refine)));
  return r;
}

geometry::SectorResolution resolving_section(const geometry::Gear& gear, const geometry::SectorResolution& regular,
                                             double centre, double reach, double cell, double growth) {
  const geometry::ToothProfile profile(gear);
  const auto arc = [&](double roll) { return roll * roll / (2 * gear.base_radius()); };
  const double form = arc(profile.roll_length_form()), tip = arc(profile.roll_length_tip());
  const double length = std::abs(tip - form);
  double place = std::clamp(std::abs(centre - form), 0.0, length);
  // A centre next to an end of the flank is that end.
  if (place < cell / 4) place = 0;
  if (length - place < cell / 4) place = length;
  double largest = 1.0 / regular.flank_cells;
  if (const auto& f = regular.flank_fractions; !f.empty()) {
    largest = 0;
    for (std::size_t i = 1; i < f.size(); ++i) largest = std::max(largest, f[i] - f[i - 1]);
  }
  // Cells from the centre towards one end, stretched to end there.
  const auto outwards = [&](double room) {
    std::vector<double> edges;
    double at = 0, size = cell;
    while (at < room) {
      if (at > reach) size = std::min(size * growth, std::max(cell, largest * length));
      edges.push_back(at += size);
    }
    if (edges.size() > 1 && edges.back() - room > size / 2) edges.pop_back();
    if (!edges.empty())
      for (double& edge : edges) edge *= room / edges.back();
    return edges;
  };
  geometry::SectorResolution s = regular;
  s.flank_fractions.clear();
  auto down = outwards(place);
  for (auto edge = down.rbegin(); edge != down.rend(); ++edge) s.flank_fractions.push_back((place - *edge) / length);
  s.flank_fractions.push_back(place / length);
  for (const double edge : outwards(length - place)) s.flank_fractions.push_back((place + edge) / length);
  s.flank_fractions.front() = 0;
  s.flank_fractions.back() = 1;
  const double thickness = gear.tooth_thickness(gear.reference_radius());
  s.flank_layer = std::clamp(cell * s.thickness_cells / thickness, geometry::min_flank_layer, 1.0);
  return s;
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
