#include "app/report/drawings/field_view.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "app/report/plot/colour_scale.h"
#include "app/report/text/xml.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr double MPa = 1e6;

using GridPoint = std::array<long, 2>;
/// mm to hundredths of them, the unit of its paths.
GridPoint on_grid(double x, double y) { return {std::lround(100 * x), std::lround(100 * y)}; }

/// A path of polygons and lines by whole differences: a third of the size of absolute coordinates.
class GridPath {
 public:
  void move_to(const GridPoint& p) { add('m', p), start_ = p; }
  void line_to(const GridPoint& p) { add('l', p); }
  void close() { text_ += 'z', at_ = start_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void add(char command, const GridPoint& p) {
    const long x = p[0] - at_[0], y = p[1] - at_[1];
    fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{}{}{}{}"), command, x, y < 0 ? "" : " ", y);
    at_ = p;
  }
  std::string text_;
  GridPoint at_{}, start_{};  // paths start at the origin
};

std::string picture(const BodyView& view) {
  const auto& axes = view.axes;
  const bool solid = view.dimension == 3;
  struct Facet {
    double depth;
    int level;
    std::array<GridPoint, 4> corners;  // y downwards
  };
  std::vector<Facet> facets;
  Eigen::AlignedBox2d box;
  for (const auto& face : view.faces) {
    std::array<Eigen::Vector3d, 4> p;
    double stress = 0, depth = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      p[i] = axes * (view.place[face[i]] + view.exaggeration * view.moved[face[i]]) / units::mm;
      stress += view.stress[face[i]] / 4;
      depth += p[i].z() / 4;
    }
    // Seen from behind.
    if (solid && (p[2] - p[0]).cross(p[3] - p[1]).z() <= 0) continue;
    Facet facet{depth, colour_level(stress / view.colour_top), {}};
    for (std::size_t i = 0; i < 4; ++i) {
      facet.corners[i] = on_grid(p[i].x(), -p[i].y());
      box.extend(Eigen::Vector2d(p[i].x(), -p[i].y()));
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
      "<g transform=\"scale(.01)\" stroke-width=\"{:.3g}\" stroke-linejoin=\"round\">",
      low.x(), low.y(), size.x(), size.y(), escape("Deformed " + view.name), 0.06 * size.x());
  auto out = std::back_inserter(svg);
  // Neighbours of one colour in one path.
  for (std::size_t i = 0; i < facets.size();) {
    const int level = facets[i].level;
    GridPath path;
    for (; i < facets.size() && facets[i].level == level; ++i) {
      const auto& [a, b, c, d] = facets[i].corners;
      path.move_to(a);
      for (const auto* p : {&b, &c, &d}) path.line_to(*p);
      path.close();
    }
    fmt::format_to(out, "<path fill=\"{0}\" stroke=\"{0}\" d=\"{1}\"/>", level_colour(level), path.text());
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
    GridPath path;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if ((e > 0 && edges[e - 1].ends == edges[e].ends) || (e + 1 < edges.size() && edges[e + 1].ends == edges[e].ends))
        continue;  // between two faces
      const auto& face = view.faces[edges[e].number / 4];
      const std::size_t i = edges[e].number % 4;
      const Eigen::Vector3d p = axes * view.place[face[i]] / units::mm,
                            q = axes * view.place[face[(i + 1) % 4]] / units::mm;
      path.move_to(on_grid(p.x(), -p.y()));
      path.line_to(on_grid(q.x(), -q.y()));
    }
    fmt::format_to(out,
                   "<path fill=\"none\" stroke=\"#555\" stroke-opacity=\"0.55\" stroke-width=\"{:.3g}\" d=\"{}\"/>",
                   0.16 * size.x(), path.text());
  }
  return svg + "</g></svg>";
}

std::string numbers_of(const BodyView& view) {
  std::string place, moved, stress, faces;
  for (std::size_t v = 0; v < view.place.size(); ++v) {
    const Eigen::Vector3d p = view.axes * view.place[v] / units::mm, u = view.axes * view.moved[v] / units::mm;
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
      view.exaggeration, view.colour_top / MPa, colours, place, moved, stress, faces);
}

}  // namespace

std::string view_html(const BodyView& view) {
  if (view.faces.empty()) return {};
  std::string bar;
  for (int level = 0; level < colour_levels; level += 4) bar += (level == 0 ? "" : ",") + level_colour(level);
  return fmt::format(
      "<div class=\"view3d\">{}<script type=\"application/json\">{}</script>"
      "<div class=\"scale\"><i style=\"background:linear-gradient(to right,{})\"></i> von Mises stress 0 to {:.3g} MPa "
      "and more (at most {:.3g} MPa) · displacement × {:g}, at most {:.3g} µm · mesh phase {:.4g}{}</div></div>\n",
      picture(view), numbers_of(view), bar, view.colour_top / MPa, view.largest_stress / MPa, view.exaggeration,
      view.largest_displacement / units::um, view.mesh_phase,
      view.ring_tooth > 0 ? fmt::format(", ring tooth {}", view.ring_tooth) : std::string());
}

std::string field_view(const fem::BodyField& field, const fem::LoadedPosition& position, const std::string& name) {
  return view_html(body_view(field, position, name));
}

}  // namespace annulus::app
