#include "app/report/drawings/field_view.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>

#include "app/report/plot/colour_scale.h"
#include "app/report/xml.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double MPa = 1e6;
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

/// A body near its contact: faces of vertices that are seen, turned so that the contact lies in the direction of x.
struct View {
  std::vector<Eigen::Vector3d> place, moved;  // m
  std::vector<double> stress;                 // Pa
  std::vector<std::array<std::uint32_t, 4>> faces;
  double largest_displacement = 0, largest_stress = 0, size = 0;
};

View near_contact(const fem::BodyField& field) {
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
  View view;
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
double colour_top(const View& view) {
  auto sorted = view.stress;
  const auto at = static_cast<std::ptrdiff_t>(sorted.size() - 1 - sorted.size() / 200);
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return std::max(sorted[static_cast<std::size_t>(at)], 1.0);
}

/// Page axes and the direction to the eye: in the plane from above, the contact at the top; in space from before the
/// teeth, a little from below.
Eigen::Matrix3d camera(bool solid, bool teeth_inside) {
  Eigen::Matrix3d axes;
  if (!solid) {
    axes << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    return axes;
  }
  const double azimuth = -32 * units::deg, elevation = -24 * units::deg, outside = teeth_inside ? -1 : 1;
  const Eigen::Vector3d towards(outside * std::cos(elevation) * std::cos(azimuth),
                                outside * std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(towards).normalized();
  axes.row(0) = right;
  axes.row(1) = towards.cross(right);
  axes.row(2) = towards;
  return axes;
}

std::string picture(const View& view, const Eigen::Matrix3d& axes, bool solid, double exaggeration, double top,
                    const std::string& title) {
  struct Facet {
    double depth;
    int level;
    std::array<Eigen::Vector2d, 4> corners;  // y downwards
  };
  std::vector<Facet> facets;
  Eigen::AlignedBox2d box;
  for (const auto& face : view.faces) {
    std::array<Eigen::Vector3d, 4> p;
    double stress = 0, depth = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      p[i] = axes * (view.place[face[i]] + exaggeration * view.moved[face[i]]) / units::mm;
      stress += view.stress[face[i]] / 4;
      depth += p[i].z() / 4;
    }
    // Seen from behind.
    if (solid && (p[2] - p[0]).cross(p[3] - p[1]).z() <= 0) continue;
    Facet facet{depth, colour_level(stress / top), {}};
    for (std::size_t i = 0; i < 4; ++i) {
      facet.corners[i] = {p[i].x(), -p[i].y()};
      box.extend(facet.corners[i]);
    }
    facets.push_back(facet);
  }
  if (solid)
    std::stable_sort(facets.begin(), facets.end(), [](const auto& a, const auto& b) { return a.depth < b.depth; });
  else
    std::stable_sort(facets.begin(), facets.end(), [](const auto& a, const auto& b) { return a.level < b.level; });
  const double margin = 0.02 * box.sizes().maxCoeff();
  const Eigen::Vector2d low = box.min().array() - margin, size = box.sizes().array() + 2 * margin;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.2f} {:.2f} {:.2f} {:.2f}\" role=\"img\" "
      "aria-label=\"{}\">"
      "<g stroke-width=\"{:.3g}\" stroke-linejoin=\"round\">",
      low.x(), low.y(), size.x(), size.y(), escape(title), 0.0006 * size.x());
  auto out = std::back_inserter(svg);
  // Neighbours of one colour in one path.
  for (std::size_t i = 0; i < facets.size();) {
    const int level = facets[i].level;
    fmt::format_to(out, "<path fill=\"{0}\" stroke=\"{0}\" d=\"", level_colour(level));
    for (; i < facets.size() && facets[i].level == level; ++i) {
      const auto& [a, b, c, d] = facets[i].corners;
      fmt::format_to(out, FMT_COMPILE("M{:.2f} {:.2f}L{:.2f} {:.2f}L{:.2f} {:.2f}L{:.2f} {:.2f}Z"), a.x(), a.y(), b.x(),
                     b.y(), c.x(), c.y(), d.x(), d.y());
    }
    svg += "\"/>";
  }
  // Where the body was: the outline of a plane one.
  if (!solid) {
    using Place = std::array<long, 2>;
    struct Edge {
      std::array<Place, 2> ends;  // in order
      std::size_t number;         // of its first corner, face by face
    };
    const auto key = [&](std::uint32_t v) {
      return Place{std::lround(view.place[v].x() * 1e8), std::lround(view.place[v].y() * 1e8)};
    };
    std::vector<Edge> edges;
    for (std::size_t f = 0; f < view.faces.size(); ++f)
      for (std::size_t i = 0; i < 4; ++i) {
        const auto a = key(view.faces[f][i]), b = key(view.faces[f][(i + 1) % 4]);
        edges.push_back({{std::min(a, b), std::max(a, b)}, 4 * f + i});
      }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
    fmt::format_to(out, "<path fill=\"none\" stroke=\"#555\" stroke-opacity=\"0.55\" stroke-width=\"{:.3g}\" d=\"",
                   0.0016 * size.x());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if ((e > 0 && edges[e - 1].ends == edges[e].ends) || (e + 1 < edges.size() && edges[e + 1].ends == edges[e].ends))
        continue;  // between two faces
      const auto& face = view.faces[edges[e].number / 4];
      const std::size_t i = edges[e].number % 4;
      const Eigen::Vector3d p = axes * view.place[face[i]] / units::mm,
                            q = axes * view.place[face[(i + 1) % 4]] / units::mm;
      fmt::format_to(out, FMT_COMPILE("M{:.2f} {:.2f}L{:.2f} {:.2f}"), p.x(), -p.y(), q.x(), -q.y());
    }
    svg += "\"/>";
  }
  return svg + "</g></svg>";
}

std::string numbers_of(const View& view, const Eigen::Matrix3d& axes, double exaggeration, double top) {
  std::string place, moved, stress, faces;
  for (std::size_t v = 0; v < view.place.size(); ++v) {
    const Eigen::Vector3d p = axes * view.place[v] / units::mm, u = axes * view.moved[v] / units::mm;
    fmt::format_to(std::back_inserter(place), FMT_COMPILE("{:.3f},{:.3f},{:.3f},"), p.x(), p.y(), p.z());
    fmt::format_to(std::back_inserter(moved), FMT_COMPILE("{:.4g},{:.4g},{:.4g},"), u.x(), u.y(), u.z());
    fmt::format_to(std::back_inserter(stress), FMT_COMPILE("{:.4g},"), view.stress[v] / MPa);
  }
  for (const auto& q : view.faces)
    fmt::format_to(std::back_inserter(faces), FMT_COMPILE("{},{},{},{},"), q[0], q[1], q[2], q[3]);
  for (auto* list : {&place, &moved, &stress, &faces})
    if (!list->empty()) list->pop_back();  // the last comma
  std::string colours;
  for (int level = 0; level < colour_levels; ++level)
    colours += fmt::format("{}\"{}\"", level == 0 ? "" : ",", level_colour(level));
  return fmt::format(
      "{{\"exaggeration\":{:.6g},\"top_MPa\":{:.6g},\"colours\":[{}],\"place_mm\":[{}],\"displacement_mm\":[{}],"
      "\"stress_MPa\":[{}],\"faces\":[{}]}}",
      exaggeration, top / MPa, colours, place, moved, stress, faces);
}

/// 1, 2 or 5 times a power of ten, so that the largest displacement becomes about a thirtieth of the body.
double exaggeration_of(const View& view) {
  const double wanted = 0.03 * view.size / std::max(view.largest_displacement, 1e-15);
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= wanted) return factor * power;
  return power;
}

}  // namespace

std::string field_view(const fem::BodyField& field, const fem::LoadedPosition& position, const std::string& name) {
  if (field.mesh.cells.empty()) return {};
  const View view = near_contact(field);
  const bool solid = field.mesh.dimension == 3;
  // A ring's teeth point inwards: what touches lies nearer to its axis than its middle.
  double contact_radius = 0, mean_radius = 0, highest = 0;
  for (std::size_t v = 0; v < view.place.size(); ++v) {
    const double radius = view.place[v].head<2>().norm();
    mean_radius += radius / static_cast<double>(view.place.size());
    if (view.stress[v] > highest) highest = view.stress[v], contact_radius = radius;
  }
  const auto axes = camera(solid, contact_radius < mean_radius);
  const double exaggeration = exaggeration_of(view), top = colour_top(view);
  std::string bar;
  for (int level = 0; level < colour_levels; level += 4) bar += (level == 0 ? "" : ",") + level_colour(level);
  return fmt::format(
      "<div class=\"view3d\">{}<script type=\"application/json\">{}</script>"
      "<div class=\"scale\"><i style=\"background:linear-gradient(to right,{})\"></i> von Mises stress 0 to {:.3g} MPa "
      "and "
      "more (at most {:.3g} MPa) · displacement × {:g}, at most {:.3g} µm · mesh phase "
      "{:.4g}{}</div></div>\n",
      picture(view, axes, solid, exaggeration, top, "Deformed " + name), numbers_of(view, axes, exaggeration, top), bar,
      top / MPa, view.largest_stress / MPa, exaggeration, view.largest_displacement / units::um, position.mesh_phase,
      position.ring_tooth > 0 ? fmt::format(", ring tooth {}", position.ring_tooth) : std::string());
}

}  // namespace annulus::app
