#include "geometry/sector_mesh.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "core/errors.h"
#include "core/units.h"
#include "geometry/gmsh_session.h"

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
namespace sector {

enum class Spacing { uniform, both_ends, growing };

double sign_of(const Gear& gear) { return gear.kind() == GearKind::external ? 1.0 : -1.0; }

Eigen::Vector2d polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

void check(const Gear& gear, const Rim& rim, const SectorResolution& n) {
  require(n.flank_cells >= 1 && n.fillet_cells >= 2 && n.fillet_cells % 2 == 0 && n.thickness_cells >= 1 &&
              n.root_cells >= 1 && n.rim_cells >= 1 && n.flank_layer > 0 && n.flank_layer <= 1,
          "sector resolution out of range");
  const bool external = gear.kind() == GearKind::external;
  const double module = gear.parameters().module;
  const double thickness = sign_of(gear) * (gear.root_radius() - rim.support_radius);
  const double needed = min_circle_distance * module;
  if (rim.support_radius <= 0 || thickness < needed) {
    throw GeometryError(fmt::format(
        "the {} with {} teeth has no rim: its {} diameter {:.4f} mm leaves {:.4f} mm beyond the root diameter {:.4f} "
        "mm, at "
        "least {} modules = {:.4f} mm are needed; {} the {} diameter",
        external ? "external gear" : "ring", gear.teeth(), external ? "bore" : "outside",
        2 * rim.support_radius / units::mm, thickness / units::mm, 2 * gear.root_radius() / units::mm,
        min_circle_distance, needed / units::mm, external ? "reduce" : "enlarge", external ? "bore" : "outside"));
  }
  for (const double circle : rim.circles) {
    const double below_root = sign_of(gear) * (gear.root_radius() - circle);
    if (below_root < needed * (1 - 1e-9) || below_root >= thickness) {
      throw GeometryError(
          fmt::format("the mesh circle with diameter {:.4f} mm does not lie in the rim between the diameters {:.4f} "
                      "and {:.4f} mm (the "
                      "root with {} modules of distance, and the {})",
                      2 * circle / units::mm, 2 * (gear.root_radius() - sign_of(gear) * needed) / units::mm,
                      2 * rim.support_radius / units::mm, min_circle_distance, external ? "bore" : "outside diameter"));
    }
  }
}

/// gmsh's bump law makes the cell size a parabola along the curve with the end-to-centre ratio c; the end cell relative
/// to a uniform one is then c atanh(k) / k with k = sqrt(1 - c).
double bump_coefficient(double end_cell) {
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
class Builder {
 public:
  int point(const Eigen::Vector2d& p) { return gmsh::model::geo::addPoint(p.x(), p.y(), 0); }

  int curve(int tag, int cells, Boundary boundary, Spacing spacing = Spacing::uniform, double coefficient = 1) {
    const bool plain = spacing == Spacing::uniform || std::abs(coefficient - 1) < 1e-6;
    curves_.push_back({tag, boundary});
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
    blocks_.push_back({tag, region});
  }

  [[nodiscard]] const std::vector<std::pair<int, Boundary>>& curves() const { return curves_; }
  [[nodiscard]] const std::vector<std::pair<int, Mesh::Region>>& blocks() const { return blocks_; }

 private:
  std::vector<std::pair<int, Boundary>> curves_;
  std::vector<std::pair<int, Mesh::Region>> blocks_;
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

void build(const Gear& gear, const Rim& rim, const SectorResolution& n, Builder& b) {
  const ToothProfile profile(gear);
  const double sign = sign_of(gear);
  const double module = gear.parameters().module;
  const double bump = n.flank_layer < 1 ? bump_coefficient(n.flank_layer) : 1;
  const auto mirrored = [](Eigen::Vector2d p) {
    p.y() = -p.y();
    return p;
  };
  const auto across = Spacing::both_ends;
  const int half_fillet = n.fillet_cells / 2;
  const int centre = b.point({0, 0});

  // Points of the tooth; index 0 on the trailing, 1 on the leading side.
  const Eigen::Vector2d tip = profile.flank_point(profile.roll_length_tip());
  const Eigen::Vector2d form = profile.flank_point(profile.roll_length_form());
  const Eigen::Vector2d middle = profile.fillet_point(0.5);
  const Eigen::Vector2d end = profile.fillet_point(1);
  const double side_angle = gear.pitch_angle() / 2;

  struct Half {
    int tip, form, middle, end, side;
    int flank, upper_fillet, lower_fillet, root;
  };
  std::array<Half, 2> halves{};
  for (int h = 0; h < 2; ++h) {
    const auto at = [&](const Eigen::Vector2d& p) { return h == 1 ? p : mirrored(p); };
    Half& s = halves[h];
    s.tip = b.point(at(tip));
    s.form = b.point(at(form));
    s.middle = b.point(at(middle));
    s.end = b.point(at(end));
    s.side = b.point(at(polar(gear.root_radius(), side_angle)));
    // Spline points equidistant in arc length, which grows with the square of the roll length.
    constexpr int flank_points = 24;
    constexpr int fillet_points = 12;
    const double tip_square = std::pow(profile.roll_length_tip(), 2);
    const double form_square = std::pow(profile.roll_length_form(), 2);
    std::vector<Eigen::Vector2d> flank, upper, lower;
    for (int i = 1; i < flank_points; ++i) {
      const double u = static_cast<double>(i) / flank_points;
      flank.push_back(at(profile.flank_point(std::sqrt(tip_square + u * (form_square - tip_square)))));
    }
    for (int i = 1; i < fillet_points; ++i) {
      const double u = 0.5 * i / fillet_points;
      upper.push_back(at(profile.fillet_point(u)));
      lower.push_back(at(profile.fillet_point(0.5 + u)));
    }
    const bool leading = h == 1;
    s.flank =
        b.spline(s.tip, flank, s.form, n.flank_cells, leading ? Boundary::leading_flank : Boundary::trailing_flank);
    const auto fillet = leading ? Boundary::leading_fillet : Boundary::trailing_fillet;
    s.upper_fillet = b.spline(s.form, upper, s.middle, half_fillet, fillet);
    s.lower_fillet = b.spline(s.middle, lower, s.end, half_fillet, fillet);
    s.root = b.arc(s.end, centre, s.side, n.root_cells, Boundary::root);
  }

  // The dipping line: at the middle of a fillet a straight angle is shared by tooth, lower fillet and rim, so it leaves
  // the fillet at 60 degrees as far as its dip stays flat.
  const Eigen::Vector2d upwards = -profile.fillet_tangent(0.5);
  const double half_width = middle.y();
  const double dip_angle = std::atan2(sign * upwards.x(), upwards.y()) + std::numbers::pi / 3 - std::numbers::pi;
  const double slope = std::tan(std::clamp(dip_angle, 0.0, 35 * units::deg));
  std::vector<Eigen::Vector2d> dip;
  constexpr int dip_points = 16;
  for (int i = 1; i < dip_points; ++i) {
    const double v = 2.0 * i / dip_points - 1;
    dip.emplace_back(middle.x() - sign * 0.5 * half_width * slope * (1 - v * v), v * half_width);
  }
  const int bottom = b.spline(halves[0].middle, dip, halves[1].middle, n.thickness_cells, Boundary::none, across, bump);
  const int crest = b.arc(halves[0].tip, centre, halves[1].tip, n.thickness_cells, Boundary::tip, across, bump);
  b.block({crest, halves[1].flank, halves[1].upper_fillet, -bottom, -halves[0].upper_fillet, -halves[0].flank},
          {halves[0].tip, halves[1].tip, halves[1].middle, halves[0].middle}, Mesh::Region::tooth);

  // The rim, row by row from the root to the support.
  std::vector<double> radii = rim.circles;
  radii.push_back(rim.support_radius);
  std::ranges::sort(radii, [&](double p, double q) { return sign * p > sign * q; });
  const auto rest = std::ranges::unique(radii, [&](double p, double q) { return std::abs(p - q) < 1e-9 * module; });
  radii.erase(rest.begin(), rest.end());
  std::array<int, 6> points{halves[0].side,   halves[0].end, halves[0].middle,
                            halves[1].middle, halves[1].end, halves[1].side};
  std::array<int, 5> tops{-halves[0].root, -halves[0].lower_fillet, bottom, halves[1].lower_fillet, halves[1].root};
  const double total = std::abs(gear.root_radius() - rim.support_radius);
  double upper_radius = gear.root_radius();
  double middle_angle = std::atan2(middle.y(), middle.x());
  double end_angle = std::atan2(end.y(), end.x());
  int cells_left = n.rim_cells;
  for (std::size_t row = 0; row < radii.size(); ++row) {
    const double radius = radii[row];
    const double height = std::abs(radius - upper_radius);
    const bool last = row + 1 == radii.size();
    const int rows_below = static_cast<int>(radii.size() - row) - 1;
    const int cells = last ? std::max(1, cells_left)
                           : std::clamp(static_cast<int>(std::lround(n.rim_cells * height / total)), 1,
                                        std::max(1, cells_left - rows_below));
    cells_left -= cells;
    // Lean towards the tooth below the middle of the fillet: it halves the angle left there and evens out the cells.
    const double lean = std::min(0.25 * height, 0.25 * half_width) / radius;
    if (row == 0) {
      middle_angle = std::max(middle_angle - lean, 0.4 * side_angle);
      end_angle = std::clamp(end_angle - 0.5 * lean, middle_angle + 0.1 * (side_angle - middle_angle), end_angle);
    }
    const double q = row == 0 ? growth(height, 2 * half_width / n.thickness_cells, cells) : 1;
    const std::array<double, 6> angles{-side_angle, -end_angle, -middle_angle, middle_angle, end_angle, side_angle};
    std::array<int, 6> below{};
    std::array<int, 6> down{};
    for (int i = 0; i < 6; ++i) {
      below[i] = b.point(polar(radius, angles[i]));
      const auto side = i == 0 ? Boundary::side_low : i == 5 ? Boundary::side_high : Boundary::none;
      down[i] = b.line(points[i], below[i], cells, side, Spacing::growing, q);
    }
    const std::array<int, 5> counts{n.root_cells, half_fillet, n.thickness_cells, half_fillet, n.root_cells};
    std::array<int, 5> bottoms{};
    for (int i = 0; i < 5; ++i) {
      bottoms[i] = b.arc(below[i], centre, below[i + 1], counts[i], last ? Boundary::support : Boundary::none,
                         i == 2 ? across : Spacing::uniform, i == 2 ? bump : 1);
      b.block({tops[i], down[i + 1], -bottoms[i], -down[i]}, {points[i], points[i + 1], below[i + 1], below[i]},
              Mesh::Region::rim);
    }
    points = below;
    tops = bottoms;
    upper_radius = radius;
  }
}

/// Reads the generated mesh back, with vertices in the order of gmsh's node numbers.
Mesh collect(const Builder& b) {
  constexpr int msh_edge = 1;
  constexpr int msh_quad = 3;
  Mesh mesh;
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters, -1, -1, false, false);
  std::map<std::size_t, Eigen::Vector3d> nodes;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    nodes[tags[i]] = {coordinates[3 * i], coordinates[3 * i + 1], 0};
  }
  std::vector<std::size_t> elements, corners;
  std::map<std::size_t, std::uint32_t> index;
  // gmsh refills vectors without shrinking them: they have to come in empty.
  const auto read_elements = [&](int type, int entity) {
    elements.clear();
    corners.clear();
    gmsh::model::mesh::getElementsByType(type, elements, corners, entity);
  };
  const auto vertex = [&](std::size_t tag) {
    const auto [entry, added] = index.try_emplace(tag, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(nodes.at(tag));
    return entry->second;
  };
  for (const auto& [block, region] : b.blocks()) {
    read_elements(msh_quad, block);
    require(!elements.empty(), "gmsh has not filled a block of the sector with quadrilaterals");
    for (std::size_t e = 0; e < elements.size(); ++e) {
      std::array<std::uint32_t, 8> cell{};
      for (std::size_t i = 0; i < 4; ++i) cell[i] = vertex(corners[4 * e + i]);
      const Eigen::Vector3d d = mesh.vertices[cell[2]] - mesh.vertices[cell[0]];
      const Eigen::Vector3d f = mesh.vertices[cell[3]] - mesh.vertices[cell[1]];
      if (d.x() * f.y() - d.y() * f.x() < 0) std::swap(cell[1], cell[3]);
      mesh.cells.push_back(cell);
      mesh.regions.push_back(region);
    }
  }
  for (const auto& [curve, boundary] : b.curves()) {
    if (boundary == Boundary::none) continue;
    read_elements(msh_edge, curve);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      mesh.faces.push_back({{vertex(corners[2 * e]), vertex(corners[2 * e + 1])}, boundary});
    }
  }
  return mesh;
}

/// Boundary edges run with the body on their left, as the cells do.
void orient_faces(Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  for (const auto& cell : mesh.cells) {
    for (int i = 0; i < 4; ++i) directed[{cell[i], cell[(i + 1) % 4]}] += 1;
  }
  for (auto& face : mesh.faces) {
    if (!directed.contains({face.vertices[0], face.vertices[1]})) std::swap(face.vertices[0], face.vertices[1]);
    require(directed.contains({face.vertices[0], face.vertices[1]}), "a boundary edge belongs to no cell");
  }
}

/// Moves the boundary vertices onto the exact curves and makes the two sides exact images of each other.
void snap(Mesh& mesh, const Gear& gear, double support_radius) {
  const ToothProfile profile(gear);
  const double half_pitch = gear.pitch_angle() / 2;
  for (int pass = 0; pass < 2; ++pass) {  // sides last: they decide the angle, the circles the radius
    for (const auto& face : mesh.faces) {
      const bool side = face.boundary == Boundary::side_low || face.boundary == Boundary::side_high;
      if (side != (pass == 1)) continue;
      for (int i = 0; i < 2; ++i) {
        Eigen::Vector3d& v = mesh.vertices[face.vertices[i]];
        if (side) {
          const double r = v.head<2>().norm();
          const double angle = face.boundary == Boundary::side_high ? half_pitch : -half_pitch;
          v.head<2>() = polar(r, angle);
        } else {
          v.head<2>() = profile.project(face.boundary, v.head<2>(), support_radius);
        }
      }
    }
  }
}

/// The two sides are meshed by the same law; what differs by rounding is made equal.
void match_sides(Mesh& mesh) {
  const auto side = [&](Boundary boundary) {
    std::map<double, std::uint32_t> by_radius;
    for (const auto& face : mesh.faces) {
      if (face.boundary != boundary) continue;
      for (int i = 0; i < 2; ++i) by_radius[mesh.vertices[face.vertices[i]].norm()] = face.vertices[i];
    }
    return by_radius;
  };
  const auto low = side(Boundary::side_low);
  const auto high = side(Boundary::side_high);
  require(low.size() == high.size(), "the sides of a sector have different numbers of vertices");
  for (auto l = low.begin(), h = high.begin(); l != low.end(); ++l, ++h) {
    const Eigen::Vector3d& v = mesh.vertices[h->second];
    mesh.vertices[l->second] = {v.x(), -v.y(), 0};
  }
}

}  // namespace sector

}  // namespace

Mesh make_sector_mesh(const Gear& gear, const Rim& rim, const SectorResolution& resolution) {
  sector::check(gear, rim, resolution);
  Mesh mesh;
  try {
    const GmshModel model("annulus sector");
    sector::Builder builder;
    sector::build(gear, rim, resolution, builder);
    gmsh::model::geo::synchronize();
    gmsh::model::mesh::generate(2);
    mesh = sector::collect(builder);
  } catch (const std::string& message) {
    throw InternalError("internal error: gmsh could not mesh a tooth sector: " + message);
  } catch (int) {
    throw InternalError("internal error: gmsh could not mesh a tooth sector");
  }
  sector::orient_faces(mesh);
  sector::snap(mesh, gear, rim.support_radius);
  sector::match_sides(mesh);
  const double worst = mesh.worst_scaled_jacobian();
  if (!(worst > 0)) {
    throw GeometryError(
        fmt::format("the tooth sector of the gear with {} teeth cannot be meshed without inverted cells (worst "
                    "scaled Jacobian {:.3f}); thicken the rim or change the root fillet",
                    gear.teeth(), worst));
  }
  return mesh;
}

}  // namespace annulus::geometry
