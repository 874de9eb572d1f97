#include "geometry/gmsh/sector_blocks.h"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/units.h"
#include "geometry/spacing.h"

namespace annulus::geometry {

namespace {

// Blocks of a sector, seen with the tooth up (external gear; an internal gear is the same upside down):
//
//              ___tip___
//             |         |            tooth: flanks and the upper halves of the fillets, down to a dipping line
//      flank  |  tooth  |  flank            between the middles of the two fillets
//             |         |
//        ____/\_________/\____       rim: one block each under root land, lower fillet, tooth, lower fillet, root
//       |root|f|  tooth |f|root|          land, and again for every mesh circle further down
//       |____|_|________|_|____|
//                support
//
// gmsh fills the blocks by transfinite interpolation. Its own laws for the spacing of vertices on a curve know neither
// a prescribed list nor thin layers to rounding, so every curve is handed over as a chain of one-cell lines between
// vertices placed here, on the exact outline.

/// One-cell lines from point to point; gmsh tags.
using Chain = std::vector<int>;

/// Collects curves and blocks in gmsh's built-in kernel.
class BlockBuilder {
 public:
  /// Lengths go to gmsh in modules: its absolute tolerances are made for numbers near one.
  explicit BlockBuilder(double module) : module_(module) {}

  int point(const Eigen::Vector2d& p) { return gmsh::model::geo::addPoint(p.x() / module_, p.y() / module_, 0); }

  /// Lines over all `vertices`; the first and the last one are the existing points a and b.
  Chain chain(int a, const std::vector<Eigen::Vector2d>& vertices, int b, Boundary boundary) {
    Chain lines;
    int from = a;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      const int to = i + 1 == vertices.size() ? b : point(vertices[i]);
      lines.push_back(gmsh::model::geo::addLine(from, to));
      gmsh::model::geo::mesh::setTransfiniteCurve(lines.back(), 2);
      result_.curves.push_back({lines.back(), boundary});
      from = to;
    }
    return lines;
  }
  void block(const std::vector<Chain>& loop, const std::vector<int>& corners, Mesh::Region region) {
    std::vector<int> curves;
    for (const auto& side : loop) curves.insert(curves.end(), side.begin(), side.end());
    const int tag = gmsh::model::geo::addPlaneSurface({gmsh::model::geo::addCurveLoop(curves)});
    gmsh::model::geo::mesh::setTransfiniteSurface(tag, "Left", corners);
    gmsh::model::geo::mesh::setRecombine(2, tag);
    result_.blocks.push_back({tag, region});
  }

  [[nodiscard]] const SectorBlocks& result() const { return result_; }

 private:
  double module_;
  SectorBlocks result_;
};

/// The chain walked the other way (gmsh: negative tags).
Chain reversed(const Chain& chain) {
  Chain result(chain.rbegin(), chain.rend());
  for (int& curve : result) curve = -curve;
  return result;
}

double sign_of(const Gear& gear) { return gear.kind() == GearKind::external ? 1.0 : -1.0; }

Eigen::Vector2d at_angle(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

std::vector<Eigen::Vector2d> arc(double radius, double from, double to, const std::vector<double>& fractions) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(fractions.size());
  for (const double f : fractions) points.push_back(at_angle(radius, from + f * (to - from)));
  return points;
}

std::vector<Eigen::Vector2d> straight(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                      const std::vector<double>& fractions) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(fractions.size());
  for (const double f : fractions) points.push_back(from + f * (to - from));
  return points;
}

/// Vertices of the leading flank from the tip to the form circle. The arc length of an involute grows with the square
/// of the roll length.
std::vector<Eigen::Vector2d> flank_vertices(const ToothProfile& profile, const SectorResolution& n) {
  const auto fractions = n.flank_fractions.empty() ? uniform_fractions(n.flank_cells) : n.flank_fractions;
  const double tip_square = std::pow(profile.roll_length_tip(), 2);
  const double form_square = std::pow(profile.roll_length_form(), 2);
  std::vector<Eigen::Vector2d> vertices;
  for (auto f = fractions.rbegin(); f != fractions.rend(); ++f) {
    vertices.push_back(profile.flank_point(std::sqrt(form_square + *f * (tip_square - form_square))));
  }
  return vertices;
}

/// Points and curves of one half of the tooth, gmsh tags.
struct HalfTooth {
  int tip = 0, form = 0, middle = 0, end = 0, side = 0;
  Chain flank, upper_fillet, lower_fillet, root;  ///< from the tip to the middle of the space
};

struct ToothLines {
  HalfTooth trailing, leading;
  Chain bottom;  ///< the dipping line, from trailing to leading
};

HalfTooth add_half(const Gear& gear, const SectorResolution& n, bool leading, BlockBuilder& b) {
  const ToothProfile profile(gear);
  const auto mirrored = [&](std::vector<Eigen::Vector2d> points) {
    if (!leading) {
      for (auto& p : points) p.y() = -p.y();
    }
    return points;
  };
  const auto half_fillet = [&](double start) {
    return mirrored(points_at([&](double t) { return profile.fillet_point(start + 0.5 * t); },
                              uniform_fractions(n.fillet_cells / 2)));
  };
  const double end_angle = std::atan2(profile.fillet_point(1).y(), profile.fillet_point(1).x());
  const auto flank = mirrored(flank_vertices(profile, n));
  const auto upper = half_fillet(0);
  const auto lower = half_fillet(0.5);
  const auto root =
      mirrored(arc(gear.root_radius(), end_angle, gear.pitch_angle() / 2, uniform_fractions(n.root_cells)));
  HalfTooth s;
  s.tip = b.point(flank.front());
  s.form = b.point(flank.back());
  s.middle = b.point(lower.front());
  s.end = b.point(lower.back());
  s.side = b.point(root.back());
  const auto fillet = leading ? Boundary::leading_fillet : Boundary::trailing_fillet;
  s.flank = b.chain(s.tip, flank, s.form, leading ? Boundary::leading_flank : Boundary::trailing_flank);
  s.upper_fillet = b.chain(s.form, upper, s.middle, fillet);
  s.lower_fillet = b.chain(s.middle, lower, s.end, fillet);
  s.root = b.chain(s.end, root, s.side, Boundary::root);
  return s;
}

/// Radii at which rows of rim blocks end, from the root to the support.
std::vector<double> row_radii(const Gear& gear, const Rim& rim) {
  const double sign = sign_of(gear);
  std::vector<double> radii = rim.circles;
  radii.push_back(rim.support_radius);
  std::ranges::sort(radii, [&](double p, double q) { return sign * p > sign * q; });
  const auto same = [&](double p, double q) { return std::abs(p - q) < 1e-9 * gear.parameters().module; };
  radii.erase(std::unique(radii.begin(), radii.end(), same), radii.end());
  return radii;
}

ToothLines add_tooth(const Gear& gear, const Rim& rim, const SectorResolution& n, BlockBuilder& b) {
  const ToothProfile profile(gear);
  const auto across = both_ends_fractions(n.thickness_cells, n.flank_layer);
  const double sign = sign_of(gear);
  ToothLines lines;
  lines.trailing = add_half(gear, n, false, b);
  lines.leading = add_half(gear, n, true, b);

  // The dipping line: at the middle of a fillet a straight angle is shared by tooth, lower fillet and rim, so the line
  // leaves the fillet at 60 degrees as far as its dip stays flat and leaves room for the first row of the rim.
  const Eigen::Vector2d middle = profile.fillet_point(0.5);
  const Eigen::Vector2d upwards = -profile.fillet_tangent(0.5);
  const double half_width = middle.y();
  const double dip_angle = std::atan2(sign * upwards.x(), upwards.y()) + std::numbers::pi / 3 - std::numbers::pi;
  const double room = sign * (middle.x() - row_radii(gear, rim).front());
  const double slope = std::min(std::tan(std::clamp(dip_angle, 0.0, 35 * units::deg)), 0.8 * room / half_width);
  const auto dip = [&](double t) -> Eigen::Vector2d {
    const double v = 2 * t - 1;
    return {middle.x() - sign * 0.5 * half_width * slope * (1 - v * v), v * half_width};
  };
  const double tip_angle = gear.tooth_half_angle(gear.tip_form_radius());
  const auto& low = lines.trailing;
  const auto& high = lines.leading;
  lines.bottom = b.chain(low.middle, points_at(dip, across), high.middle, Boundary::none);
  const Chain crest =
      b.chain(low.tip, arc(gear.tip_form_radius(), -tip_angle, tip_angle, across), high.tip, Boundary::tip);
  b.block(
      {crest, high.flank, high.upper_fillet, reversed(lines.bottom), reversed(low.upper_fillet), reversed(low.flank)},
      {low.tip, high.tip, high.middle, low.middle}, Mesh::Region::tooth);
  return lines;
}

void add_rim(const Gear& gear, const Rim& rim, const SectorResolution& n, const ToothLines& lines, BlockBuilder& b) {
  const ToothProfile profile(gear);
  const double side_angle = gear.pitch_angle() / 2;
  const Eigen::Vector2d middle = profile.fillet_point(0.5);
  const Eigen::Vector2d end = profile.fillet_point(1);
  const double half_width = middle.y();
  double middle_angle = std::atan2(middle.y(), middle.x());
  double end_angle = std::atan2(end.y(), end.x());

  const auto& low = lines.trailing;
  const auto& high = lines.leading;
  constexpr double steepest_rim = 1.7;
  std::array<Eigen::Vector2d, 6> above{
      at_angle(gear.root_radius(), -side_angle), {end.x(), -end.y()}, {middle.x(), -middle.y()}, middle, end,
      at_angle(gear.root_radius(), side_angle)};
  std::array<int, 6> points{low.side, low.end, low.middle, high.middle, high.end, high.side};
  std::array<Chain, 5> tops{reversed(low.root), reversed(low.lower_fillet), lines.bottom, high.lower_fillet, high.root};
  const auto root = uniform_fractions(n.root_cells);
  const auto fillet = uniform_fractions(n.fillet_cells / 2);
  const std::array<std::vector<double>, 5> across{root, fillet, both_ends_fractions(n.thickness_cells, n.flank_layer),
                                                  fillet, root};
  const auto radii = row_radii(gear, rim);
  const double total = std::abs(gear.root_radius() - rim.support_radius);
  double upper_radius = gear.root_radius();
  int cells_left = n.rim_cells;
  for (std::size_t row = 0; row < radii.size(); ++row) {
    const double radius = radii[row];
    const double height = std::abs(radius - upper_radius);
    const bool last = row + 1 == radii.size();
    const int rows_below = static_cast<int>(radii.size() - row) - 1;
    constexpr double half_up = 1e-9;  // else rounding of the radii, and with it the unit of length, decides on halves
    const int share = static_cast<int>(std::lround(n.rim_cells * height / total + half_up));
    const int cells = last ? std::max(1, cells_left) : std::clamp(share, 1, std::max(1, cells_left - rows_below));
    cells_left -= cells;
    double ratio = 1;
    if (row == 0) {
      // Lean towards the tooth below the middle of the fillet: it halves the angle left there and evens out the cells.
      const double lean = 0.25 * std::min(height, half_width) / radius;
      middle_angle = std::max(middle_angle - lean, 0.4 * side_angle);
      end_angle = std::clamp(end_angle - 0.5 * lean, middle_angle + 0.1 * (side_angle - middle_angle), end_angle);
      ratio = growth_ratio(height, 2 * half_width / n.thickness_cells, cells, steepest_rim);
    }
    const std::array<double, 6> angles{-side_angle, -end_angle, -middle_angle, middle_angle, end_angle, side_angle};
    const auto down_fractions = growing_fractions(cells, ratio);
    std::array<int, 6> below{};
    std::array<Chain, 6> down{};
    for (std::size_t i = 0; i < 6; ++i) {
      const Eigen::Vector2d foot = at_angle(radius, angles[i]);
      below[i] = b.point(foot);
      const auto side = i == 0 ? Boundary::side_low : i == 5 ? Boundary::side_high : Boundary::none;
      down[i] = b.chain(points[i], straight(above[i], foot, down_fractions), below[i], side);
      above[i] = foot;
    }
    std::array<Chain, 5> bottoms{};
    for (std::size_t i = 0; i < 5; ++i) {
      bottoms[i] = b.chain(below[i], arc(radius, angles[i], angles[i + 1], across[i]), below[i + 1],
                           last ? Boundary::support : Boundary::none);
      b.block({tops[i], down[i + 1], reversed(bottoms[i]), reversed(down[i])},
              {points[i], points[i + 1], below[i + 1], below[i]}, Mesh::Region::rim);
    }
    points = below;
    tops = bottoms;
    upper_radius = radius;
  }
}

}  // namespace

SectorBlocks describe_sector(const Gear& gear, const Rim& rim, const SectorResolution& resolution) {
  BlockBuilder builder(gear.parameters().module);
  const ToothLines lines = add_tooth(gear, rim, resolution, builder);
  add_rim(gear, rim, resolution, lines, builder);
  return builder.result();
}

}  // namespace annulus::geometry
