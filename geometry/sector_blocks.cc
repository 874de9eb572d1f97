#include "geometry/sector_blocks.h"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/units.h"

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
enum class Spacing { uniform, both_ends, growing };

/// gmsh's bump law makes the cell size a parabola along the curve with the end-to-centre ratio c; the end cell relative
/// to a uniform one is then c atanh(k) / k with k = sqrt(1 - c).
double bump_coefficient(double end_cell) {
  if (end_cell >= 1) return 1;
  double low = 1e-9;
  double high = 1 - 1e-9;
  for (int i = 0; i < 60; ++i) {
    const double c = std::sqrt(low * high);
    const double k = std::sqrt(1 - c);
    (c * std::atanh(k) / k < end_cell ? low : high) = c;
  }
  return std::sqrt(low * high);
}

/// Collects curves and blocks in gmsh's built-in kernel; mesh constraints follow after the synchronisation.
class BlockBuilder {
 public:
  /// Lengths go to gmsh in modules: its absolute tolerances are made for numbers near one.
  explicit BlockBuilder(double module) : module_(module) {}

  int point(const Eigen::Vector2d& p) { return gmsh::model::geo::addPoint(p.x() / module_, p.y() / module_, 0); }

  int curve(int tag, int cells, Boundary boundary, Spacing spacing = Spacing::uniform, double coefficient = 1) {
    const bool plain = spacing == Spacing::uniform || std::abs(coefficient - 1) < 1e-6;
    result_.curves.push_back({tag, boundary});
    gmsh::model::geo::mesh::setTransfiniteCurve(
        tag, cells + 1, !plain && spacing == Spacing::both_ends ? "Bump" : "Progression", plain ? 1.0 : coefficient);
    return tag;
  }
  int line(int a, int b, int cells, Boundary boundary, Spacing spacing = Spacing::uniform, double coefficient = 1) {
    return curve(gmsh::model::geo::addLine(a, b), cells, boundary, spacing, coefficient);
  }
  int arc(int a, int centre, int b, int cells, Boundary boundary, Spacing spacing = Spacing::uniform,
          double coefficient = 1) {
    return curve(gmsh::model::geo::addCircleArc(a, centre, b), cells, boundary, spacing, coefficient);
  }
  /// Interpolating curve from point a over the inner points to point b.
  int spline(int a, const std::vector<Eigen::Vector2d>& inner, int b, int cells, Boundary boundary,
             Spacing spacing = Spacing::uniform, double coefficient = 1) {
    std::vector<int> tags{a};
    for (const auto& p : inner) tags.push_back(point(p));
    tags.push_back(b);
    return curve(gmsh::model::geo::addSpline(tags), cells, boundary, spacing, coefficient);
  }
  void block(const std::vector<int>& loop, const std::vector<int>& corners, Mesh::Region region) {
    const int tag = gmsh::model::geo::addPlaneSurface({gmsh::model::geo::addCurveLoop(loop)});
    gmsh::model::geo::mesh::setTransfiniteSurface(tag, "Left", corners);
    gmsh::model::geo::mesh::setRecombine(2, tag);
    result_.blocks.push_back({tag, region});
  }

  [[nodiscard]] const SectorBlocks& result() const { return result_; }

 private:
  double module_;
  SectorBlocks result_;
};

/// Ratio of neighbouring cells of a geometric row of n cells of given total length that starts with a cell of size
/// `first`: 1 when that is no refinement, at most 1.7.
double growth(double length, double first, int n) {
  double low = 1;
  double high = 1.7;
  for (int i = 0; i < 50; ++i) {
    const double q = 0.5 * (low + high);
    const double sum = std::abs(q - 1) < 1e-12 ? n : (std::pow(q, n) - 1) / (q - 1);
    (first * sum < length ? low : high) = q;
  }
  return 0.5 * (low + high);
}

double sign_of(const Gear& gear) { return gear.kind() == GearKind::external ? 1.0 : -1.0; }

Eigen::Vector2d at_angle(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

/// Points and curves of one half of the tooth, gmsh tags.
struct HalfTooth {
  int tip = 0, form = 0, middle = 0, end = 0, side = 0;
  int flank = 0, upper_fillet = 0, lower_fillet = 0, root = 0;
};

struct ToothLines {
  HalfTooth trailing, leading;
  int bottom = 0;  ///< the dipping line, from trailing to leading
  int centre = 0;  ///< the axis
};

HalfTooth add_half(const Gear& gear, const SectorResolution& n, bool leading, int centre, BlockBuilder& b) {
  const ToothProfile profile(gear);
  const auto at = [&](const Eigen::Vector2d& p) { return Eigen::Vector2d(p.x(), leading ? p.y() : -p.y()); };
  HalfTooth s;
  s.tip = b.point(at(profile.flank_point(profile.roll_length_tip())));
  s.form = b.point(at(profile.flank_point(profile.roll_length_form())));
  s.middle = b.point(at(profile.fillet_point(0.5)));
  s.end = b.point(at(profile.fillet_point(1)));
  s.side = b.point(at(at_angle(gear.root_radius(), gear.pitch_angle() / 2)));
  // Spline points equidistant in arc length, which grows with the square of the roll length.
  constexpr int flank_points = 24;
  constexpr int fillet_points = 12;
  const double tip_square = std::pow(profile.roll_length_tip(), 2);
  const double form_square = std::pow(profile.roll_length_form(), 2);
  std::vector<Eigen::Vector2d> flank;
  for (int i = 1; i < flank_points; ++i) {
    const double u = static_cast<double>(i) / flank_points;
    flank.push_back(at(profile.flank_point(std::sqrt(tip_square + u * (form_square - tip_square)))));
  }
  std::vector<Eigen::Vector2d> upper;
  std::vector<Eigen::Vector2d> lower;
  for (int i = 1; i < fillet_points; ++i) {
    const double u = 0.5 * i / fillet_points;
    upper.push_back(at(profile.fillet_point(u)));
    lower.push_back(at(profile.fillet_point(0.5 + u)));
  }
  const auto fillet = leading ? Boundary::leading_fillet : Boundary::trailing_fillet;
  s.flank = b.spline(s.tip, flank, s.form, n.flank_cells, leading ? Boundary::leading_flank : Boundary::trailing_flank);
  s.upper_fillet = b.spline(s.form, upper, s.middle, n.fillet_cells / 2, fillet);
  s.lower_fillet = b.spline(s.middle, lower, s.end, n.fillet_cells / 2, fillet);
  s.root = b.arc(s.end, centre, s.side, n.root_cells, Boundary::root);
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
  const double bump = bump_coefficient(n.flank_layer);
  const double sign = sign_of(gear);
  ToothLines lines;
  lines.centre = b.point({0, 0});
  lines.trailing = add_half(gear, n, false, lines.centre, b);
  lines.leading = add_half(gear, n, true, lines.centre, b);

  // The dipping line: at the middle of a fillet a straight angle is shared by tooth, lower fillet and rim, so the line
  // leaves the fillet at 60 degrees as far as its dip stays flat and leaves room for the first row of the rim.
  const Eigen::Vector2d middle = profile.fillet_point(0.5);
  const Eigen::Vector2d upwards = -profile.fillet_tangent(0.5);
  const double half_width = middle.y();
  const double dip_angle = std::atan2(sign * upwards.x(), upwards.y()) + std::numbers::pi / 3 - std::numbers::pi;
  const double room = sign * (middle.x() - row_radii(gear, rim).front());
  const double slope = std::min(std::tan(std::clamp(dip_angle, 0.0, 35 * units::deg)), 0.8 * room / half_width);
  std::vector<Eigen::Vector2d> dip;
  constexpr int dip_points = 16;
  for (int i = 1; i < dip_points; ++i) {
    const double v = 2.0 * i / dip_points - 1;
    dip.emplace_back(middle.x() - sign * 0.5 * half_width * slope * (1 - v * v), v * half_width);
  }
  const auto& low = lines.trailing;
  const auto& high = lines.leading;
  lines.bottom = b.spline(low.middle, dip, high.middle, n.thickness_cells, Boundary::none, Spacing::both_ends, bump);
  const int crest = b.arc(low.tip, lines.centre, high.tip, n.thickness_cells, Boundary::tip, Spacing::both_ends, bump);
  b.block({crest, high.flank, high.upper_fillet, -lines.bottom, -low.upper_fillet, -low.flank},
          {low.tip, high.tip, high.middle, low.middle}, Mesh::Region::tooth);
  return lines;
}

void add_rim(const Gear& gear, const Rim& rim, const SectorResolution& n, const ToothLines& lines, BlockBuilder& b) {
  const ToothProfile profile(gear);
  const double bump = bump_coefficient(n.flank_layer);
  const double side_angle = gear.pitch_angle() / 2;
  const Eigen::Vector2d middle = profile.fillet_point(0.5);
  const Eigen::Vector2d end = profile.fillet_point(1);
  const double half_width = middle.y();
  double middle_angle = std::atan2(middle.y(), middle.x());
  double end_angle = std::atan2(end.y(), end.x());

  const auto& low = lines.trailing;
  const auto& high = lines.leading;
  std::array<int, 6> points{low.side, low.end, low.middle, high.middle, high.end, high.side};
  std::array<int, 5> tops{-low.root, -low.lower_fillet, lines.bottom, high.lower_fillet, high.root};
  const std::array<int, 5> counts{n.root_cells, n.fillet_cells / 2, n.thickness_cells, n.fillet_cells / 2,
                                  n.root_cells};
  const auto radii = row_radii(gear, rim);
  const double total = std::abs(gear.root_radius() - rim.support_radius);
  double upper_radius = gear.root_radius();
  int cells_left = n.rim_cells;
  for (std::size_t row = 0; row < radii.size(); ++row) {
    const double radius = radii[row];
    const double height = std::abs(radius - upper_radius);
    const bool last = row + 1 == radii.size();
    const int rows_below = static_cast<int>(radii.size() - row) - 1;
    const int share = static_cast<int>(std::lround(n.rim_cells * height / total));
    const int cells = last ? std::max(1, cells_left) : std::clamp(share, 1, std::max(1, cells_left - rows_below));
    cells_left -= cells;
    double ratio = 1;
    if (row == 0) {
      // Lean towards the tooth below the middle of the fillet: it halves the angle left there and evens out the cells.
      const double lean = 0.25 * std::min(height, half_width) / radius;
      middle_angle = std::max(middle_angle - lean, 0.4 * side_angle);
      end_angle = std::clamp(end_angle - 0.5 * lean, middle_angle + 0.1 * (side_angle - middle_angle), end_angle);
      ratio = growth(height, 2 * half_width / n.thickness_cells, cells);
    }
    const std::array<double, 6> angles{-side_angle, -end_angle, -middle_angle, middle_angle, end_angle, side_angle};
    std::array<int, 6> below{};
    std::array<int, 6> down{};
    for (std::size_t i = 0; i < 6; ++i) {
      below[i] = b.point(at_angle(radius, angles[i]));
      const auto side = i == 0 ? Boundary::side_low : i == 5 ? Boundary::side_high : Boundary::none;
      down[i] = b.line(points[i], below[i], cells, side, Spacing::growing, ratio);
    }
    std::array<int, 5> bottoms{};
    for (std::size_t i = 0; i < 5; ++i) {
      bottoms[i] = b.arc(below[i], lines.centre, below[i + 1], counts[i], last ? Boundary::support : Boundary::none,
                         i == 2 ? Spacing::both_ends : Spacing::uniform, i == 2 ? bump : 1);
      b.block({tops[i], down[i + 1], -bottoms[i], -down[i]}, {points[i], points[i + 1], below[i + 1], below[i]},
              Mesh::Region::rim);
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
