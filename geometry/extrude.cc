#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/errors.h"
#include "geometry/mesh.h"

namespace annulus::geometry {

namespace {

using VertexId = std::uint32_t;

/// One layer of hexahedra between two neighbouring levels.
struct Slab {
  double z_low = 0, z_high = 0;
  const Layers* stack = nullptr;
  std::vector<bool> active;  ///< one per plane cell
};

double centre_radius(const Mesh& plane, std::size_t cell) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) centre += plane.vertices[plane.cells[cell][i]] / 4;
  return centre.head<2>().norm();
}

bool belongs(const Mesh& plane, std::size_t cell, const Layers& stack) {
  if (!stack.toothed && plane.regions[cell] == Mesh::Region::tooth) return false;
  const double radius = centre_radius(plane, cell);
  return radius >= stack.radius_low && radius <= stack.radius_high;
}

std::vector<Slab> make_slabs(const Mesh& plane, const std::vector<Layers>& stacks) {
  std::vector<Slab> slabs;
  for (const auto& stack : stacks) {
    require(stack.cells >= 1 && stack.z_high > stack.z_low && stack.grading > 0, "a stack of layers is empty");
    const double height = stack.z_high - stack.z_low;
    if (!slabs.empty()) {
      require(std::abs(stack.z_low - slabs.back().z_high) <= 1e-9 * height,
              "stacks of layers have to follow each other");
    }
    std::vector<bool> active(plane.cells.size());
    for (std::size_t c = 0; c < active.size(); ++c) active[c] = belongs(plane, c, stack);
    require(std::ranges::find(active, true) != active.end(), "a stack of layers contains no cell");
    const double ratio = stack.cells > 1 ? std::pow(stack.grading, 1.0 / (stack.cells - 1)) : 1.0;
    double total = 0;
    for (int i = 0; i < stack.cells; ++i) total += std::pow(ratio, i);
    double below = 0;
    for (int i = 0; i < stack.cells; ++i) {
      const double z_low = slabs.empty() ? stack.z_low : slabs.back().z_high;
      below += std::pow(ratio, i);
      const double z_high = i == stack.cells - 1 ? stack.z_high : stack.z_low + height * below / total;
      slabs.push_back({z_low, z_high, &stack, active});
    }
  }
  return slabs;
}

constexpr std::size_t no_cell = std::numeric_limits<std::size_t>::max();

/// The two plane cells at an edge (the second is `no_cell` on the boundary) and its boundary tag; the edge runs
/// counter-clockwise about the first cell.
struct Edge {
  VertexId a = 0, b = 0;
  std::size_t cells[2] = {0, no_cell};
  Boundary boundary = Boundary::none;
};

std::vector<Edge> plane_edges(const Mesh& plane) {
  std::map<std::pair<VertexId, VertexId>, std::size_t> index;
  std::vector<Edge> edges;
  for (std::size_t c = 0; c < plane.cells.size(); ++c) {
    for (int i = 0; i < 4; ++i) {
      const VertexId a = plane.cells[c][i];
      const VertexId b = plane.cells[c][(i + 1) % 4];
      const auto [entry, added] = index.try_emplace(std::minmax(a, b), edges.size());
      if (added) {
        edges.push_back({a, b, {c, no_cell}, Boundary::none});
      } else {
        edges[entry->second].cells[1] = c;
      }
    }
  }
  for (const auto& face : plane.faces) {
    const auto entry = index.find(std::minmax(face.vertices[0], face.vertices[1]));
    require(entry != index.end(), "a boundary face of the plane mesh is no edge of a cell");
    edges[entry->second].boundary = face.boundary;
  }
  return edges;
}

/// Vertices of one level, created when they are first used: a level beside a sleeve has no vertices at the teeth.
class LevelVertices {
 public:
  LevelVertices(const Mesh& plane, Mesh& solid, std::size_t levels, const ExtrudeOptions& options)
      : plane_(plane),
        solid_(solid),
        options_(options),
        ids_(levels, std::vector<VertexId>(plane.vertices.size(), unused)) {}

  VertexId operator()(std::size_t level, VertexId v, double z) {
    auto& id = ids_[level][v];
    if (id == unused) {
      id = static_cast<VertexId>(solid_.vertices.size());
      const Eigen::Vector2d in_section = plane_.vertices[v].head<2>();
      const Eigen::Vector2d p = Eigen::Rotation2Dd(turn(in_section.norm(), z)) * in_section;
      solid_.vertices.emplace_back(p.x(), p.y(), z);
    }
    return id;
  }

 private:
  /// rad, of the section at z.
  [[nodiscard]] double turn(double radius, double z) const {
    if (!options_.straight) return options_.twist * z;
    const auto& straight = *options_.straight;
    const double faded =
        std::clamp((radius - straight.twisted_radius) / (straight.radius - straight.twisted_radius), 0.0, 1.0);
    return options_.twist * (z + faded * (straight.z - z));
  }

  static constexpr VertexId unused = std::numeric_limits<VertexId>::max();
  const Mesh& plane_;
  Mesh& solid_;
  const ExtrudeOptions& options_;
  std::vector<std::vector<VertexId>> ids_;
};

Mesh::Region region_of(const Mesh& plane, std::size_t cell, const Layers& stack, double outside_radius) {
  if (centre_radius(plane, cell) > outside_radius) return stack.band;
  return stack.region == Mesh::Region::rim ? plane.regions[cell] : stack.region;
}

/// Tag of the exposed side of an edge: its own on the boundary of the plane mesh, else by where it lies.
Boundary exposed(const Mesh& plane, const Edge& edge, double outside_radius) {
  if (edge.cells[1] == no_cell) return edge.boundary;
  const auto on_outside = [&](VertexId v) {
    return std::abs(plane.vertices[v].head<2>().norm() - outside_radius) < 1e-9 * outside_radius;
  };
  return on_outside(edge.a) && on_outside(edge.b) ? Boundary::outside : Boundary::inner;
}

}  // namespace

Mesh extrude(const Mesh& plane, const std::vector<Layers>& stacks, const ExtrudeOptions& options) {
  require(plane.dimension == 2, "only a plane mesh can be extruded");
  const auto slabs = make_slabs(plane, stacks);
  require(!slabs.empty(), "no stack of layers to extrude");
  const auto edges = plane_edges(plane);

  Mesh solid;
  solid.dimension = 3;
  LevelVertices vertex(plane, solid, slabs.size() + 1, options);
  for (std::size_t k = 0; k < slabs.size(); ++k) {
    const Slab& slab = slabs[k];
    for (std::size_t c = 0; c < plane.cells.size(); ++c) {
      if (!slab.active[c]) continue;
      std::array<VertexId, 8> cell{};
      for (int i = 0; i < 4; ++i) {
        cell[i] = vertex(k, plane.cells[c][i], slab.z_low);
        cell[i + 4] = vertex(k + 1, plane.cells[c][i], slab.z_high);
      }
      solid.cells.push_back(cell);
      solid.regions.push_back(region_of(plane, c, *slab.stack, options.outside_radius));
      // Horizontal faces, seen counter-clockwise from outside the body.
      if (k == 0 || !slabs[k - 1].active[c]) {
        const bool flange = solid.regions.back() == Mesh::Region::flange;
        const double radius = centre_radius(plane, c);
        const bool end = k == 0 && radius >= options.end_low_radius && radius <= options.outside_radius;
        const auto boundary = flange ? Boundary::flange_face : end ? Boundary::end_low : Boundary::inner;
        solid.faces.push_back({{cell[0], cell[3], cell[2], cell[1]}, boundary});
      }
      if (k + 1 == slabs.size() || !slabs[k + 1].active[c]) {
        const bool end = k + 1 == slabs.size() && centre_radius(plane, c) >= options.end_high_radius;
        solid.faces.push_back({{cell[4], cell[5], cell[6], cell[7]}, end ? Boundary::end_high : Boundary::inner});
      }
    }
    for (const auto& edge : edges) {
      const bool first = slab.active[edge.cells[0]];
      const bool second = edge.cells[1] != no_cell && slab.active[edge.cells[1]];
      if (first == second) continue;
      const VertexId a = first ? edge.a : edge.b;
      const VertexId b = first ? edge.b : edge.a;
      solid.faces.push_back({{vertex(k, a, slab.z_low), vertex(k, b, slab.z_low), vertex(k + 1, b, slab.z_high),
                              vertex(k + 1, a, slab.z_high)},
                             exposed(plane, edge, options.outside_radius)});
    }
  }
  return solid;
}

}  // namespace annulus::geometry
