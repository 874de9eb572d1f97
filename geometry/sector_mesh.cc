#include "geometry/sector_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "core/errors.h"
#include "core/units.h"
#include "geometry/meshing.h"

namespace annulus::geometry {

namespace {

void check_resolution(const SectorResolution& n) {
  require(n.flank_cells >= 1 && n.fillet_cells >= 2 && n.fillet_cells % 2 == 0 && n.thickness_cells >= 1 &&
              n.root_cells >= 1 && n.rim_cells >= 1 && n.flank_layer >= min_flank_layer && n.flank_layer <= 1,
          "sector resolution out of range");
  const auto& f = n.flank_fractions;
  require(f.empty() || (f.size() >= 2 && f.front() == 0 && f.back() == 1 &&
                        std::ranges::adjacent_find(f, std::ranges::greater_equal{}) == f.end()),
          "flank fractions have to increase strictly from 0 to 1");
}

void check_rim(const Gear& gear, const Rim& rim) {
  const bool external = gear.kind() == GearKind::external;
  const double module = gear.parameters().module;
  const double sign = external ? 1 : -1;
  const double thickness = sign * (gear.root_radius() - rim.support_radius);
  const double needed = min_circle_distance * module;
  if (rim.support_radius <= 0 || thickness < needed) {
    throw GeometryError(fmt::format(
        "the {} with {} teeth has no rim: its {} diameter {:.4f} mm leaves {:.4f} mm beyond the root diameter {:.4f} "
        "mm, at least {} modules = {:.4f} mm are needed; {} the {} diameter",
        external ? "external gear" : "ring", gear.teeth(), external ? "bore" : "outside",
        2 * rim.support_radius / units::mm, thickness / units::mm, 2 * gear.root_radius() / units::mm,
        min_circle_distance, needed / units::mm, external ? "reduce" : "enlarge", external ? "bore" : "outside"));
  }
  for (const double circle : rim.circles) {
    const double below_root = sign * (gear.root_radius() - circle);
    if (below_root < needed * (1 - 1e-9) || below_root >= thickness) {
      throw GeometryError(
          fmt::format("the mesh circle (inside of a sleeve) with diameter {:.4f} mm does not lie in the rim between "
                      "the diameters {:.4f} and {:.4f} mm (the root with {} modules of distance, and the {})",
                      2 * circle / units::mm, 2 * (gear.root_radius() - sign * needed) / units::mm,
                      2 * rim.support_radius / units::mm, min_circle_distance, external ? "bore" : "outside diameter"));
    }
  }
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
          const double radius = v.head<2>().norm();
          const double angle = face.boundary == Boundary::side_high ? half_pitch : -half_pitch;
          v.head<2>() = radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
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

}  // namespace

Mesh make_sector_mesh(const Gear& gear, const Rim& rim, const SectorResolution& resolution) {
  check_resolution(resolution);
  check_rim(gear, rim);
  Mesh mesh = meshing().sector(gear, rim, resolution);
  orient_faces(mesh);
  snap(mesh, gear, rim.support_radius);
  match_sides(mesh);
  const double worst = mesh.worst_scaled_jacobian();
  if (!(worst > 0)) {
    throw GeometryError(
        fmt::format("the tooth sector of the gear with {} teeth cannot be meshed without inverted cells (worst scaled "
                    "Jacobian {:.3f}); thicken the rim or change the root fillet",
                    gear.teeth(), worst));
  }
  return mesh;
}

}  // namespace annulus::geometry
