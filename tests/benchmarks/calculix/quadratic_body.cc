#include "benchmarks/calculix/quadratic_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "core/errors.h"
#include "geometry/sector_mesh.h"

namespace annulus::benchmarks {
namespace {

using geometry::Boundary;
using geometry::Mesh;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

int count_faces(const Mesh& mesh, Boundary boundary) {
  return static_cast<int>(
      std::count_if(mesh.faces.begin(), mesh.faces.end(), [&](const auto& f) { return f.boundary == boundary; }));
}

/// Same rim on the radial cuts: their cells depend on the counts across the tooth and along the cut.
Mesh coarse_partner(const Mesh& fine, const geometry::Gear& gear, double support_radius) {
  geometry::SectorResolution r;
  r.flank_cells = 6;
  r.fillet_cells = 4;
  r.root_cells = 1;
  r.thickness_cells = count_faces(fine, Boundary::tip);
  r.rim_cells = count_faces(fine, Boundary::side_low);
  return geometry::make_sector_mesh(gear, {support_radius, {}}, r);
}

/// One sector with its middles of sides.
QuadraticBody quadratic(const Mesh& mesh, const geometry::ToothProfile& profile, double support_radius) {
  QuadraticBody body;
  for (const auto& v : mesh.vertices) body.nodes.emplace_back(v.head<2>());
  std::map<Edge, Boundary> boundary_of;
  for (const auto& face : mesh.faces) boundary_of[{face.vertices[0], face.vertices[1]}] = face.boundary;
  std::map<Edge, int> middles;
  for (const auto& corners : mesh.cells) {
    std::array<int, 8> cell{};
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % 4];
      cell[i] = static_cast<int>(a);
      const auto [entry, added] = middles.try_emplace(std::minmax(a, b), static_cast<int>(body.nodes.size()));
      cell[4 + i] = entry->second;
      const auto side = boundary_of.find({a, b});
      const auto boundary = side != boundary_of.end() ? side->second : Boundary::none;
      if (added) {
        const Eigen::Vector2d middle = (body.nodes[a] + body.nodes[b]) / 2;
        body.nodes.push_back(profile.project(boundary, middle, support_radius));
      }
      if (boundary != Boundary::none) body.sides.push_back({static_cast<int>(body.cells.size()), i, boundary, 0});
    }
    body.cells.push_back(cell);
  }
  return body;
}

/// Nodes of a radial cut from the axis outwards.
std::vector<int> cut_nodes(const QuadraticBody& body, Boundary cut) {
  auto nodes = body.nodes_on(cut);
  std::sort(nodes.begin(), nodes.end(), [&](int a, int b) { return body.nodes[a].norm() < body.nodes[b].norm(); });
  return nodes;
}

}  // namespace

std::vector<int> QuadraticBody::nodes_on(Boundary boundary) const {
  std::vector<int> found;
  for (const auto& side : sides)
    if (side.boundary == boundary)
      for (const int i : {side.number, (side.number + 1) % 4, side.number + 4}) found.push_back(cells[side.cell][i]);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void QuadraticBody::place(double angle, const Eigen::Vector2d& centre) {
  const Eigen::Rotation2Dd turn(angle);
  for (auto& node : nodes) node = turn * node + centre;
}

QuadraticBody make_segment(const geometry::ToothProfile& profile, const Mesh& fine, double support_radius,
                           const Segment& segment) {
  const QuadraticBody fine_tooth = quadratic(fine, profile, support_radius);
  const QuadraticBody coarse_tooth =
      quadratic(coarse_partner(fine, profile.gear(), support_radius), profile, support_radius);
  QuadraticBody body;
  std::vector<int> seam;  // nodes of the last cut, already in the body
  for (int tooth = segment.first; tooth <= segment.last; ++tooth) {
    const bool is_fine = tooth >= segment.first_fine && tooth <= segment.last_fine;
    const QuadraticBody& sector = is_fine ? fine_tooth : coarse_tooth;
    const Eigen::Rotation2Dd turn(tooth * profile.gear().pitch_angle());
    std::vector<int> index(sector.nodes.size(), -1);
    if (tooth > segment.first) {
      const auto low = cut_nodes(sector, Boundary::side_low);
      require(low.size() == seam.size(), "neighbouring sectors do not conform");
      for (std::size_t i = 0; i < low.size(); ++i) {
        require((turn * sector.nodes[low[i]] - body.nodes[seam[i]]).norm() < 1e-9 * support_radius,
                "neighbouring sectors do not conform");
        index[low[i]] = seam[i];
      }
    }
    for (std::size_t i = 0; i < index.size(); ++i)
      if (index[i] < 0) {
        index[i] = static_cast<int>(body.nodes.size());
        body.nodes.push_back(turn * sector.nodes[i]);
      }
    const int first_cell = static_cast<int>(body.cells.size());
    for (auto cell : sector.cells) {
      for (int& node : cell) node = index[node];
      body.cells.push_back(cell);
    }
    for (auto side : sector.sides) {
      side.cell += first_cell;
      side.tooth = tooth;
      body.sides.push_back(side);
    }
    seam = cut_nodes(sector, Boundary::side_high);
    for (int& node : seam) node = index[node];
  }
  return body;
}

}  // namespace annulus::benchmarks
