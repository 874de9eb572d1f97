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

/// Cuts of a body, nodes of ascending radii.
struct Seams {
  std::vector<int> first, last;  ///< empty at the beginning
};

enum class UpperCut { open, on_first };
/// Adds a tooth to the body behind the last cut.
void append(QuadraticBody& body, Seams& seams, const QuadraticBody& sector, int tooth, double pitch_angle,
            double tolerance, UpperCut upper) {
  const Eigen::Rotation2Dd turn(tooth * pitch_angle);
  std::vector<int> index(sector.nodes.size(), -1);
  const auto join = [&](const std::vector<int>& cut, const std::vector<int>& seam) {
    require(cut.size() == seam.size(), "neighbouring sectors do not conform");
    for (std::size_t i = 0; i < cut.size(); ++i) {
      require((turn * sector.nodes[cut[i]] - body.nodes[seam[i]]).norm() < tolerance,
              "neighbouring sectors do not conform");
      index[cut[i]] = seam[i];
    }
  };
  const auto low = cut_nodes(sector, Boundary::side_low), high = cut_nodes(sector, Boundary::side_high);
  const bool begins = seams.first.empty();
  if (!begins) join(low, seams.last);
  if (upper == UpperCut::on_first) join(high, seams.first);
  for (std::size_t i = 0; i < index.size(); ++i)
    if (index[i] < 0) {
      index[i] = static_cast<int>(body.nodes.size());
      body.nodes.push_back(turn * sector.nodes[i]);
    }
  const auto in_body = [&](std::vector<int> cut) {
    for (int& node : cut) node = index[node];
    return cut;
  };
  if (begins) seams.first = in_body(low);
  seams.last = in_body(high);
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
  Seams seams;
  for (int tooth = segment.first; tooth <= segment.last; ++tooth)
    append(body, seams, tooth >= segment.first_fine && tooth <= segment.last_fine ? fine_tooth : coarse_tooth, tooth,
           profile.gear().pitch_angle(), 1e-9 * support_radius, UpperCut::open);
  return body;
}

QuadraticBody make_gear(const geometry::ToothProfile& profile, const Mesh& fine, double support_radius,
                        const std::set<int>& fine_teeth) {
  const QuadraticBody fine_tooth = quadratic(fine, profile, support_radius);
  const QuadraticBody coarse_tooth =
      quadratic(coarse_partner(fine, profile.gear(), support_radius), profile, support_radius);
  QuadraticBody body;
  Seams seams;
  const int teeth = profile.gear().teeth();
  for (int tooth = 0; tooth < teeth; ++tooth)
    append(body, seams, fine_teeth.count(tooth) > 0 ? fine_tooth : coarse_tooth, tooth, profile.gear().pitch_angle(),
           1e-9 * support_radius, tooth + 1 == teeth ? UpperCut::on_first : UpperCut::open);
  return body;
}

}  // namespace annulus::benchmarks
