#include "geometry/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/errors.h"

namespace annulus::geometry {

namespace {

using Index = std::uint32_t;

/// Smallest corner determinant divided by the product of the edge lengths that meet there.
double scaled_jacobian_quad(const Mesh& mesh, const std::array<Index, 8>& cell) {
  double worst = 1;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d& p = mesh.vertices[cell[i]];
    const Eigen::Vector3d a = mesh.vertices[cell[(i + 1) % 4]] - p;
    const Eigen::Vector3d b = mesh.vertices[cell[(i + 3) % 4]] - p;
    worst = std::min(worst, (a.x() * b.y() - a.y() * b.x()) / (a.norm() * b.norm()));
  }
  return worst;
}

double scaled_jacobian_hex(const Mesh& mesh, const std::array<Index, 8>& cell) {
  double worst = 1;
  for (int i = 0; i < 8; ++i) {
    const int layer = i / 4 * 4;
    const bool upper = layer == 4;
    const Eigen::Vector3d& p = mesh.vertices[cell[i]];
    const Eigen::Vector3d a = mesh.vertices[cell[layer + (i + 1) % 4]] - p;
    const Eigen::Vector3d b = mesh.vertices[cell[layer + (i + 3) % 4]] - p;
    const Eigen::Vector3d c = mesh.vertices[cell[(i + 4) % 8]] - p;
    const double det = (upper ? b.cross(a) : a.cross(b)).dot(c);
    worst = std::min(worst, det / (a.norm() * b.norm() * c.norm()));
  }
  return worst;
}

/// Volume of the trilinear hexahedron. The determinant of its Jacobian is quadratic in each coordinate: two Gauss
/// points in each direction are exact.
double hex_volume(const Mesh& mesh, const std::array<Index, 8>& cell) {
  static constexpr std::array<std::array<int, 3>, 8> corner = {
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
  const double g = 1 / std::numbers::sqrt3;
  double volume = 0;
  for (const auto& q : corner) {
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 8; ++i) {
      const auto& c = corner[i];
      const double fx = 1 + g * q[0] * c[0];
      const double fy = 1 + g * q[1] * c[1];
      const double fz = 1 + g * q[2] * c[2];
      const Eigen::RowVector3d gradient(c[0] * fy * fz / 8, c[1] * fx * fz / 8, c[2] * fx * fy / 8);
      jacobian += mesh.vertices[cell[i]] * gradient;
    }
    volume += jacobian.determinant();
  }
  return volume;
}

/// Vertices on one side of a sector in the order of z, then radius: the same order on both sides.
std::vector<Index> side_vertices(const Mesh& mesh, Boundary side) {
  std::vector<Index> found;
  for (const auto& face : mesh.faces) {
    if (face.boundary != side) continue;
    found.insert(found.end(), face.vertices.begin(), face.vertices.begin() + (mesh.dimension == 2 ? 2 : 4));
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::ranges::sort(found, [&](Index i, Index j) {
    const auto& a = mesh.vertices[i];
    const auto& b = mesh.vertices[j];
    return a.z() != b.z() ? a.z() < b.z() : a.head<2>().squaredNorm() < b.head<2>().squaredNorm();
  });
  return found;
}

}  // namespace

double Mesh::worst_scaled_jacobian() const {
  double worst = std::numeric_limits<double>::infinity();
  for (const auto& cell : cells) {
    worst = std::min(worst, dimension == 2 ? scaled_jacobian_quad(*this, cell) : scaled_jacobian_hex(*this, cell));
  }
  return worst;
}

double Mesh::area_or_volume() const {
  double sum = 0;
  for (const auto& cell : cells) {
    if (dimension == 3) {
      sum += hex_volume(*this, cell);
    } else {
      const Eigen::Vector3d d = vertices[cell[2]] - vertices[cell[0]];
      const Eigen::Vector3d e = vertices[cell[3]] - vertices[cell[1]];
      sum += 0.5 * (d.x() * e.y() - d.y() * e.x());
    }
  }
  return sum;
}

Mesh repeat(const Mesh& sector, int teeth, int count) {
  require(count >= 1 && count <= teeth, "repeat needs a count between 1 and the number of teeth");
  const auto low = side_vertices(sector, Boundary::side_low);
  const auto high = side_vertices(sector, Boundary::side_high);
  require(!low.empty() && low.size() == high.size(), "the two sides of a sector have to match");
  const double pitch = 2 * std::numbers::pi / teeth;
  const Eigen::AngleAxisd turn(pitch, Eigen::Vector3d::UnitZ());
  for (std::size_t i = 0; i < low.size(); ++i) {
    // make_sector_mesh matches the sides to rounding; anything worse means that the vertices are not partners.
    const auto& target = sector.vertices[high[i]];
    require((turn * sector.vertices[low[i]] - target).norm() <= 1e-9 * target.norm(),
            "the sides of a sector do not match");
  }
  constexpr Index own = std::numeric_limits<Index>::max();
  std::vector<Index> partner(sector.vertices.size(), own);  // on side_low: the vertex of side_high it becomes
  for (std::size_t i = 0; i < low.size(); ++i) partner[low[i]] = high[i];
  std::vector<Index> back(sector.vertices.size(), own);
  for (std::size_t i = 0; i < low.size(); ++i) back[high[i]] = low[i];

  const bool closed = count == teeth && teeth > 1;
  Mesh result;
  result.dimension = sector.dimension;
  std::vector<Index> first(sector.vertices.size());
  std::vector<Index> previous;
  std::vector<Index> current(sector.vertices.size());
  for (int copy = 0; copy < count; ++copy) {
    const Eigen::AngleAxisd rotation(copy * pitch, Eigen::Vector3d::UnitZ());
    const bool last_of_ring = closed && copy == count - 1;
    for (std::size_t v = 0; v < sector.vertices.size(); ++v) {
      if (copy > 0 && partner[v] != own) {
        current[v] = previous[partner[v]];
      } else if (last_of_ring && back[v] != own) {
        current[v] = first[back[v]];
      } else {
        current[v] = static_cast<Index>(result.vertices.size());
        result.vertices.push_back(copy == 0 ? sector.vertices[v] : rotation * sector.vertices[v]);
      }
    }
    if (copy == 0) first = current;
    previous = current;
    for (auto cell : sector.cells) {
      for (int i = 0; i < (sector.dimension == 2 ? 4 : 8); ++i) cell[i] = current[cell[i]];
      result.cells.push_back(cell);
    }
    result.regions.insert(result.regions.end(), sector.regions.begin(), sector.regions.end());
    for (auto face : sector.faces) {
      if (face.boundary == Boundary::side_low && (copy > 0 || closed)) continue;
      if (face.boundary == Boundary::side_high && (copy < count - 1 || closed)) continue;
      for (int i = 0; i < (sector.dimension == 2 ? 2 : 4); ++i) face.vertices[i] = current[face.vertices[i]];
      result.faces.push_back(face);
    }
  }
  return result;
}

}  // namespace annulus::geometry
