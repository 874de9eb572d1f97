#include "fem/body/resolution.h"

#include <fmt/format.h>

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

/// m, on the reference circle, or at the end of the flank next to it: a large profile shift moves teeth beyond it.
double tooth_thickness(const geometry::Gear& gear) {
  const auto [low, high] = std::minmax({gear.form_radius(), gear.tip_form_radius()});
  return gear.tooth_thickness(std::clamp(gear.reference_radius(), low, high));
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

/// Fractions of a length, from 0 to 1, in cells whose lengths follow `size`.
template <class Size>
std::vector<double> sized_fractions(double length, const Size& size) {
  // Number of cells up to a place: the integral of 1 / size.
  std::vector<double> places = {0}, counts = {0};
  while (places.back() < length) {
    const double step = std::min(size(places.back()) / 16, length - places.back());
    counts.push_back(counts.back() + step / size(places.back() + step / 2));
    places.push_back(places.back() + step);
    if (step < 1e-12 * length) break;
  }
  const auto cells = std::max<std::ptrdiff_t>(1, std::lround(counts.back()));
  std::vector<double> fractions = {0};
  for (std::ptrdiff_t i = 1; i < cells; ++i) {
    const double count = counts.back() * static_cast<double>(i) / static_cast<double>(cells);
    const auto above = std::upper_bound(counts.begin(), counts.end(), count) - counts.begin();
    const double t = (count - counts[above - 1]) / (counts[above] - counts[above - 1]);
    fractions.push_back(((1 - t) * places[above - 1] + t * places[above]) / length);
  }
  fractions.push_back(1);
  return fractions;
}

}  // namespace

BodyResolution plane_resolution(const geometry::Gear& gear, int level, int degree) {
  require(level >= 0 && level <= last_plane_level,
          fmt::format("level {} of plane resolution; there are 0 to {}", level, last_plane_level));
  // Linear elements of the size that does for quadratic ones are estimated to about 1 % at level 1, now a little less,
  // now a little more: somewhat smaller ones are within it.
  const double smaller = degree == 1 ? 1.2 : 1;
  const double refine = smaller * std::pow(level_ratio, level - 1);
  const double length = flank_length(gear), thickness = tooth_thickness(gear);
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
                                             const ContactCells& contact) {
  const geometry::ToothProfile profile(gear);
  const auto arc = [&](double roll) { return roll * roll / (2 * gear.base_radius()); };
  const double form = arc(profile.roll_length_form()), tip = arc(profile.roll_length_tip());
  const double length = std::abs(tip - form);
  const auto from_form = [&](double place) { return std::clamp(std::abs(place - form), 0.0, length); };
  double largest = 1.0 / regular.flank_cells;
  if (const auto& f = regular.flank_fractions; !f.empty()) {
    largest = 0;
    for (std::size_t i = 1; i < f.size(); ++i) largest = std::max(largest, f[i] - f[i - 1]);
  }
  const double cell = contact.cell, centre = from_form(contact.centre), slope = std::log(contact.growth);
  std::vector<double> breaks = {0};
  for (const double edge : contact.edges) breaks.push_back(from_form(edge));
  const auto size = [&, edges = std::vector<double>(breaks.begin() + 1, breaks.end())](double x) {
    double h = cell + slope * std::max(0.0, std::abs(x - centre) - contact.reach);
    h = std::min(h, std::max(cell, largest * length));
    for (const double edge : edges) h = std::min(h, contact.at_edge + slope * std::abs(x - edge));
    return h;
  };
  breaks.push_back(length);
  std::sort(breaks.begin(), breaks.end());

  geometry::SectorResolution s = regular;
  s.flank_fractions = {0};
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const double low = breaks[i - 1], high = breaks[i];
    if (high - low < size(high) / 4) {  // an edge next to an end of the flank is that end
      if (i + 1 == breaks.size()) s.flank_fractions.back() = 1;
      continue;
    }
    const auto fractions = sized_fractions(high - low, [&](double x) { return size(low + x); });
    for (std::size_t k = 1; k < fractions.size(); ++k)
      s.flank_fractions.push_back((low + (high - low) * fractions[k]) / length);
  }
  s.flank_fractions.back() = 1;
  const double thickness = tooth_thickness(gear), per_layer = thickness / s.thickness_cells;
  // Not thinner than the layers of the regular section: see plane_resolution about the fillet.
  const double layer =
      contact.edges.empty() ? cell : std::max(contact.at_edge, std::min(cell, regular.flank_layer * per_layer));
  s.flank_layer = std::clamp(layer / per_layer, geometry::min_flank_layer, 1.0);
  return s;
}

BodyResolution solid_resolution(int level, int degree, double overlap_ratio) {
  require(level >= 0 && level <= last_solid_level,
          fmt::format("level {} of solid resolution; there are 0 to {}", level, last_solid_level));
  using Levels = std::array<BodyResolution, last_solid_level + 1>;
  static const Levels linear = {{
      {{7, 2, 4, 1, 2, 1.0}, 5, 2},
      {{10, 2, 6, 1, 3, 0.8}, 8, 3},
      {{15, 4, 8, 1, 4, 0.8}, 12, 4},
  }};
  // Measured one by one on sleeves, crowned and helical teeth: with layers of the rim the error falls with their fifth
  // power, with cells along face and sleeve with their square. Each direction leaves about as much as the others:
  // less than its step between two levels, but for the first along the face (six to eight cells), which leaves 1.3
  // times as much.
  static const Levels quadratic = {{
      {{7, 2, 4, 1, 4, 1.0}, 6, 3},
      {{10, 2, 6, 1, 5, 0.8}, 8, 5},
      {{15, 4, 8, 1, 6, 0.8}, 12, 7},
  }};
  BodyResolution r = (degree == 1 ? linear : quadratic)[level];
  // Linear cells along the face leave nearly all of the error of helical teeth: with eight of them 2 %, with twelve
  // less than 1 % (overlap ratio 1), whatever the section.
  if (degree == 1) r.face_cells = static_cast<int>(std::lround(r.face_cells * (1 + overlap_ratio / 2)));
  return r;
}

int support_slices(const LoadedMeshProblem& problem, int face_cells) {
  // Against one per layer: transmission error 7e-5, pin forces 0.13 % of the largest (72 teeth of 12 degrees, 24 pins).
  constexpr int most_of_helical = 4;
  return std::max(1, problem.pair.pinion().helix_angle() != 0 ? std::min(face_cells, most_of_helical) : face_cells);
}

int slices_per_cell(const LoadedMeshProblem& problem, int degree) {
  const auto uneven = [](const geometry::Gear& gear) {
    const auto& p = gear.parameters();
    return p.helix_angle != 0 || geometry::modified_along_face(p);
  };
  // A slice carries a constant load on a line along the axis: what that leaves of an uneven load, or of the slanted
  // contact of helical teeth, falls with the square of their number.
  const bool more = uneven(problem.pair.pinion()) || uneven(problem.pair.wheel()) || problem.misalignment != 0;
  return degree > 1 && more ? 3 : 2;
}

int pressure_elements(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level) {
  const bool solid = settings.fidelity == Fidelity::solid, helical = problem.pair.pinion().helix_angle() != 0;
  const double first = !solid ? 10 : settings.degree == 1 && helical ? 3 : 6;
  return static_cast<int>(std::lround(first * std::pow(1.25, level - 1)));
}

BodyResolution resolved_solid_resolution(int level) {
  const double refine = std::pow(level_ratio, level - 1);
  BodyResolution r = solid_resolution(level, 2);
  r.section.thickness_cells = 2 * static_cast<int>(std::lround(5 * refine));
  r.section.rim_cells = std::max(2, static_cast<int>(std::lround(3 * refine)));
  return r;
}

}  // namespace annulus::fem
