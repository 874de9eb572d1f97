#include "app/report/drawings/body_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/units.h"

namespace annulus::app {

namespace {

constexpr std::size_t most_faces = 5000;  // of a view: some hundred kilobytes

/// Quadrilaterals seen of some of its cells: in the plane the cells, in space the faces of one of them alone.
std::vector<std::array<std::uint32_t, 4>> faces_of(const geometry::Mesh& mesh, std::size_t first_cell,
                                                   std::size_t cells) {
  std::vector<std::array<std::uint32_t, 4>> faces;
  if (mesh.dimension == 2) {
    for (std::size_t k = first_cell; k < first_cell + cells; ++k) {
      const auto& c = mesh.cells[k];
      faces.push_back({c[0], c[1], c[2], c[3]});
    }
    return faces;
  }
  // Sectors have vertices of their own: faces between cells are those whose middles coincide.
  static constexpr int corners[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                        {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  std::map<std::array<long, 3>, std::pair<int, std::array<std::uint32_t, 4>>> at;
  for (std::size_t k = first_cell; k < first_cell + cells; ++k)
    for (const auto& side : corners) {
      const auto& cell = mesh.cells[k];
      const std::array<std::uint32_t, 4> face = {cell[side[0]], cell[side[1]], cell[side[2]], cell[side[3]]};
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const auto v : face) middle += mesh.vertices[v] / 4;
      constexpr double same = 1e-8;  // m
      auto& entry =
          at[{std::lround(middle.x() / same), std::lround(middle.y() / same), std::lround(middle.z() / same)}];
      ++entry.first;
      entry.second = face;
    }
  for (const auto& [place, entry] : at)
    if (entry.first == 1) faces.push_back(entry.second);
  return faces;
}

BodyView near_contact(const fem::BodyField& field) {
  const auto& mesh = field.mesh;
  std::size_t worst = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (field.von_mises(v) > field.von_mises(worst)) worst = v;
  const double contact = std::atan2(mesh.vertices[worst].y(), mesh.vertices[worst].x());
  // Whole sectors around it.
  const auto sectors = static_cast<std::size_t>(field.sectors);
  const std::size_t vertices = mesh.vertices.size() / sectors, cells = mesh.cells.size() / sectors,
                    middle = worst / vertices;
  const std::size_t each_side = std::max<std::size_t>(1, most_faces / faces_of(mesh, middle * cells, cells).size() / 2);
  const std::size_t first = middle - std::min(middle, each_side), last = std::min(middle + each_side, sectors - 1);
  BodyView view;
  const Eigen::AngleAxisd turn(-contact, Eigen::Vector3d::UnitZ());
  constexpr std::uint32_t unseen = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), unseen);
  Eigen::AlignedBox3d box;
  for (const auto& face : faces_of(mesh, first * cells, (last - first + 1) * cells)) {
    auto& kept = view.faces.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      const bool fresh = number[face[i]] == unseen;
      if (fresh) number[face[i]] = static_cast<std::uint32_t>(view.place.size());
      kept[i] = number[face[i]];
      if (!fresh) continue;
      view.place.emplace_back(turn * mesh.vertices[face[i]]);
      view.moved.emplace_back(turn * field.displacement[face[i]]);
      view.stress.push_back(field.von_mises(face[i]));
      view.largest_displacement = std::max(view.largest_displacement, view.moved.back().norm());
      view.largest_stress = std::max(view.largest_stress, view.stress.back());
      box.extend(view.place.back());
    }
  }
  view.size = box.sizes().maxCoeff();
  return view;
}

/// Upper end of the colours: what only a thousandth of the vertices exceeds. The peak under the contact would make all
/// else pale.
double colour_top_of(const BodyView& view) {
  auto sorted = view.stress;
  const auto at = static_cast<std::ptrdiff_t>(sorted.size() - 1 - sorted.size() / 200);
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return std::max(sorted[static_cast<std::size_t>(at)], 1.0);
}

enum class TeethSide { inside, outside };

/// Page axes and the direction to the eye: in the plane from above, the contact at the top; in space from before the
/// teeth, a little from below.
Eigen::Matrix3d camera(int dimension, TeethSide teeth) {
  Eigen::Matrix3d axes;
  if (dimension == 2) {
    axes << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    return axes;
  }
  const double azimuth = -32 * units::deg, elevation = -24 * units::deg, outside = teeth == TeethSide::inside ? -1 : 1;
  const Eigen::Vector3d towards(outside * std::cos(elevation) * std::cos(azimuth),
                                outside * std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(towards).normalized();
  axes.row(0) = right;
  axes.row(1) = towards.cross(right);
  axes.row(2) = towards;
  return axes;
}

/// 1, 2 or 5 times a power of ten, so that the largest displacement becomes about a thirtieth of the body.
double exaggeration_of(const BodyView& view) {
  const double wanted = 0.03 * view.size / std::max(view.largest_displacement, 1e-15);
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= wanted) return factor * power;
  return power;
}

}  // namespace

BodyView body_view(const fem::BodyField& field, const fem::LoadedPosition& position, const std::string& name) {
  if (field.mesh.cells.empty()) return {};
  BodyView view = near_contact(field);
  // A ring's teeth point inwards: what touches lies nearer to its axis than its middle.
  double contact_radius = 0, mean_radius = 0, highest = 0;
  for (std::size_t v = 0; v < view.place.size(); ++v) {
    const double radius = view.place[v].head<2>().norm();
    mean_radius += radius / static_cast<double>(view.place.size());
    if (view.stress[v] > highest) highest = view.stress[v], contact_radius = radius;
  }
  view.name = name;
  view.dimension = field.mesh.dimension;
  view.axes = camera(view.dimension, contact_radius < mean_radius ? TeethSide::inside : TeethSide::outside);
  view.exaggeration = exaggeration_of(view);
  view.colour_top = colour_top_of(view);
  view.mesh_phase = position.mesh_phase;
  view.ring_tooth = position.ring_tooth;
  return view;
}

}  // namespace annulus::app
