#include "app/report/drawings/deformed_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/report/drawings/facets.h"
#include "app/report/plot/colour_scale.h"
#include "app/report/plot/ticks.h"
#include "core/units.h"
#include "fem/placed_field.h"

namespace annulus::app {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeformedMesh, name, place_mm, displacement_mm, stress_MPa, faces, solid,
                                   largest_displacement_mm, largest_stress_MPa, exaggeration, top_MPa, mesh_phase,
                                   ring_tooth)

namespace {

constexpr std::size_t most_faces = 5000;  // of a view: some hundred kilobytes
constexpr double MPa = 1e6;

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

/// The faces seen of whole sectors on both sides of a vertex.
std::vector<std::array<std::uint32_t, 4>> faces_around(const fem::BodyField& field, std::size_t vertex) {
  const auto& mesh = field.mesh;
  const auto sectors = static_cast<std::size_t>(field.sectors);
  const std::size_t cells = mesh.cells.size() / sectors, middle = vertex / (mesh.vertices.size() / sectors);
  const std::size_t each_side = std::max<std::size_t>(1, most_faces / faces_of(mesh, middle * cells, cells).size() / 2);
  const std::size_t first = middle - std::min(middle, each_side), last = std::min(middle + each_side, sectors - 1);
  return faces_of(mesh, first * cells, (last - first + 1) * cells);
}

/// Page axes: the line of centres upright; of solids from a little before their lower faces.
Eigen::Matrix3d page_axes(int dimension) {
  Eigen::Matrix3d upright = Eigen::AngleAxisd(90 * units::deg, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  if (dimension == 2) return upright;
  // The eye below the plane sees the sectors of the lower half of a symmetric face from outside.
  const auto behind = Eigen::AngleAxisd(180 * units::deg, Eigen::Vector3d::UnitY());
  const auto aside = Eigen::AngleAxisd(-28 * units::deg, Eigen::Vector3d::UnitY());
  const auto above = Eigen::AngleAxisd(18 * units::deg, Eigen::Vector3d::UnitX());
  return (above * aside * behind).toRotationMatrix() * upright;
}

std::size_t most_stressed(const fem::BodyField& field) {
  std::size_t worst = 0;
  for (std::size_t v = 0; v < field.mesh.vertices.size(); ++v)
    if (field.von_mises(v) > field.von_mises(worst)) worst = v;
  return worst;
}

/// What only a few of the vertices exceed: the peak under the contact would make all else pale.
double colour_top(std::vector<double> stress) {
  const auto at = static_cast<std::ptrdiff_t>(stress.size() - 1 - stress.size() / 200);
  std::nth_element(stress.begin(), stress.begin() + at, stress.end());
  return std::max(stress[static_cast<std::size_t>(at)], 1 / MPa);
}

/// Rounded to a micrometre of the page axes.
void add_place(std::vector<double>& list, const Eigen::Vector3d& place_mm) {
  for (const double x : place_mm) list.push_back(std::round(1000 * x) / 1000);
}

/// Edges of one face alone, of vertices that coincide.
std::vector<std::array<Eigen::Vector3d, 2>> outline(const DeformedMesh& view) {
  using Place = std::array<double, 3>;
  const auto place = [&](std::size_t corner) {
    const double* p = &view.place_mm[3 * std::size_t{view.faces[corner]}];
    return Place{p[0], p[1], p[2]};
  };
  std::map<std::pair<Place, Place>, int> faces;
  for (std::size_t f = 0; f < view.faces.size(); f += 4)
    for (std::size_t i = 0; i < 4; ++i) {
      const auto a = place(f + i), b = place(f + (i + 1) % 4);
      ++faces[std::minmax(a, b)];
    }
  std::vector<std::array<Eigen::Vector3d, 2>> lines;
  for (const auto& [edge, count] : faces)
    if (count == 1) lines.push_back({Eigen::Vector3d(edge.first.data()), Eigen::Vector3d(edge.second.data())});
  return lines;
}

}  // namespace

DeformedMesh deformed_mesh(const fem::BodyField& pinion, const fem::BodyField& wheel,
                           const fem::LoadedPosition& position, const geometry::GearPair& pair,
                           const std::string& name) {
  DeformedMesh view{.name = name,
                    .solid = wheel.mesh.dimension == 3,
                    .mesh_phase = position.mesh_phase,
                    .ring_tooth = position.ring_tooth};
  if (pinion.mesh.cells.empty() || wheel.mesh.cells.empty()) return view;
  const Eigen::Matrix3d axes = page_axes(wheel.mesh.dimension);
  Eigen::AlignedBox3d box;
  const auto add = [&](const fem::BodyField& field) {
    const auto placed = fem::in_frame_of_pair(field, position, pair);
    std::map<std::uint32_t, std::uint32_t> numbers;
    const auto before = static_cast<std::uint32_t>(view.stress_MPa.size());
    for (const auto& face : faces_around(field, most_stressed(field)))
      for (const auto v : face) {
        const auto [number, fresh] = numbers.try_emplace(v, before + static_cast<std::uint32_t>(numbers.size()));
        view.faces.push_back(number->second);
        if (!fresh) continue;
        const Eigen::Vector3d& place = placed.mesh.vertices[v];
        const Eigen::Vector3d moved = axes * placed.displacement[v] / units::mm;
        add_place(view.place_mm, axes * place / units::mm);
        for (const double x : moved) view.displacement_mm.push_back(significant(x, 4));
        view.stress_MPa.push_back(significant(field.von_mises(v) / MPa, 4));
        view.largest_displacement_mm = std::max(view.largest_displacement_mm, moved.norm());
        view.largest_stress_MPa = std::max(view.largest_stress_MPa, field.von_mises(v) / MPa);
        box.extend(place / units::mm);
      }
  };
  add(wheel);
  add(pinion);
  view.exaggeration = round_below(fem::visible_exaggeration(box.sizes().maxCoeff(), view.largest_displacement_mm));
  view.top_MPa = colour_top(view.stress_MPa);
  return view;
}

void share_colours(const std::vector<DeformedMesh*>& views) {
  double top = 0;
  for (const auto* view : views) top = std::max(top, view->top_MPa);
  if (!(top > 0)) return;
  const double step = round_below(top / 4);
  for (auto* view : views) view->top_MPa = step * std::ceil(top / step - 1e-9);
}

std::string to_svg(const DeformedMesh& view) {
  const auto colours = scale_colours(Ways::one);
  std::vector<std::pair<std::size_t, Facet>> facets;  // by level
  for (std::size_t f = 0; f < view.faces.size(); f += 4) {
    Facet facet;
    double stress = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t v = view.faces[f + i];
      facet.corners[i] =
          Eigen::Vector3d(&view.place_mm[3 * v]) + view.exaggeration * Eigen::Vector3d(&view.displacement_mm[3 * v]);
      stress += view.stress_MPa[v] / 4;
    }
    if (view.solid && facet.normal().z() <= 0) continue;  // seen from behind
    const auto level = colour_level(stress / view.top_MPa);
    facet.fill = colours[level];
    facets.emplace_back(level, facet);
  }
  FacetPicture picture{.label = "Deformed " + view.name, .edge_width = 0.0006};
  if (!view.solid)
    std::stable_sort(facets.begin(), facets.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [level, facet] : facets) picture.facets.push_back(facet);
  if (view.solid)
    sort_by_depth(picture.facets);
  else
    picture.lines = outline(view);
  return to_svg(picture);
}

namespace {

/// Numbers in whole steps of a unit, each as the difference to the one `stride` before: they pack to a third.
template <class Values>
nlohmann::json in_steps(const Values& values, double unit, std::size_t stride) {
  std::vector<long> steps(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) steps[i] = std::lround(static_cast<double>(values[i]) / unit);
  for (std::size_t i = steps.size(); i-- > stride;) steps[i] -= steps[i - stride];
  return {{"unit", unit}, {"stride", stride}, {"steps", steps}};
}

double step_of(const std::vector<double>& values, double steps) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return largest > 0 ? largest / steps : 1;
}

}  // namespace

nlohmann::json view_data(const DeformedMesh& view) {
  constexpr double screen = 20'000, shades = 1000;  // finer than any screen, and than any eye
  nlohmann::json data = view;
  data["place_mm"] = in_steps(view.place_mm, step_of(view.place_mm, screen), 3);
  data["displacement_mm"] = in_steps(view.displacement_mm, step_of(view.displacement_mm, shades), 3);
  data["stress_MPa"] = in_steps(view.stress_MPa, step_of(view.stress_MPa, shades), 1);
  data["faces"] = in_steps(view.faces, 1, 4);
  data["colours"] = scale_colours(Ways::one);
  return data;
}

}  // namespace annulus::app
