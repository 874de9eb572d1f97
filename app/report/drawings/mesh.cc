#include "app/report/drawings/mesh.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "app/report/drawings/drawing_page.h"
#include "app/report/drawings/support.h"
#include "core/units.h"
#include "geometry/gear_places.h"

namespace annulus::app {

namespace {

using geometry::Boundary;
using geometry::Mesh;

// ---- plane: all teeth are copies of one sector, so it is written once and used again ----

constexpr DrawingPage mesh_page{1 / units::mm};

std::string cells_path(const Mesh& mesh) {
  std::string d;
  for (const auto& cell : mesh.cells) {
    for (int i = 0; i < 4; ++i) {
      const auto& v = mesh.vertices[cell[static_cast<std::size_t>(i)]];
      d += (i == 0 ? "M" : "L") + mesh_page.text(v.head<2>());
    }
    d += "Z";
  }
  return d;
}

/// Free boundary of the sector, without the cuts to its neighbours.
std::string outline_path(const Mesh& mesh) {
  std::string d;
  for (const auto& face : mesh.faces) {
    if (face.boundary == Boundary::side_low || face.boundary == Boundary::side_high) continue;
    const auto &a = mesh.vertices[face.vertices[0]], &b = mesh.vertices[face.vertices[1]];
    d += "M" + mesh_page.text(a.head<2>()) + "L" + mesh_page.text(b.head<2>());
  }
  return d;
}

std::string teeth(const Mesh& sector, const std::string& id, const char* fill, double pitch, double first,
                  int each_side, double centre, double pen) {
  std::string svg = fmt::format(
      "<defs><g id=\"{}\"><path d=\"{}\" fill=\"{}\" stroke=\"#46586a\" stroke-opacity=\"0.6\" "
      "stroke-width=\"{:.3g}\"/><path d=\"{}\" fill=\"none\" stroke=\"#2c3a48\" stroke-width=\"{:.3g}\" "
      "stroke-linecap=\"round\"/></g></defs>",
      id, cells_path(sector), fill, 0.025 * pen, outline_path(sector), 0.22 * pen);
  for (int i = -each_side; i <= each_side; ++i) {
    // On the page the y axis points down and x became upright: a counter-clockwise angle turns by minus the angle.
    svg += fmt::format("<use href=\"#{}\" transform=\"translate(0 {:.3f}) rotate({:.5f})\"/>", id, -centre / units::mm,
                       -(first + i * pitch) / units::deg);
  }
  return svg;
}

std::string supports(const fem::LoadedMeshProblem& problem, double first, double reach) {
  const double radius = problem.wheel_support_radius;
  return problem.pair.internal() ? drawn_supports(mesh_page, problem.structure, radius, first, reach)
                                 : held_arc(mesh_page, radius, first, reach);
}

std::string plane_picture(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshResult& solved,
                          const std::string& name) {
  const auto& pair = problem.pair;
  const auto &planet = pair.planet(), &wheel = pair.wheel();
  const double centre = pair.centre_distance();
  const auto [planet_first, wheel_first] = geometry::pair_places(pair);  // pitch-point contact
  const double wheel_pitch = wheel.base_radius() / std::cos(pair.working_pressure_angle());

  constexpr int each_side = 4;
  const double half_width = 3.4 * wheel.pitch_angle() * wheel_pitch;
  const double low = pair.internal() ? centre + problem.planet_bore_radius : problem.wheel_support_radius;
  const double high = pair.internal() ? problem.wheel_support_radius : centre - problem.planet_bore_radius;
  const double margin = support_margin(problem.structure, problem.wheel_support_radius);
  const double width = 2 * half_width / units::mm, height = (high - low + 2 * margin) / units::mm;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.2f} {:.2f} {:.2f} {:.2f}\" role=\"img\" "
      "aria-label=\"mesh\">",
      -width / 2, -(high + margin) / units::mm, width, height);
  const double pen = planet.parameters().module / (3.8 * units::mm);  // lines as thick for the eye, whatever the size
  svg += teeth(solved.wheel_sector, "wheel-" + name, wheel_fill, wheel.pitch_angle(), wheel_first, each_side, 0, pen);
  svg += teeth(solved.planet_sector, "planet-" + name, planet_fill, planet.pitch_angle(), planet_first, each_side,
               centre, pen);
  svg += supports(problem, wheel_first, (each_side + 0.5) * wheel.pitch_angle());
  svg +=
      fmt::format("<circle cx=\"0\" cy=\"{:.3f}\" r=\"{:.3g}\" fill=\"none\" stroke=\"#000\" stroke-width=\"{:.3g}\"/>",
                  -wheel_pitch / units::mm, 0.9 * pen, 0.35 * pen);
  return svg + "</svg>";
}

// ---- space: boundary faces sorted from far to near ----

struct Camera {
  Eigen::Vector3d right, up, towards;  ///< page axes and the direction from the scene to the eye
};

/// From inside the ring, looking outwards and a little upwards: teeth, sleeve and the held face below all show.
Camera camera() {
  const double azimuth = -32 * units::deg, elevation = -24 * units::deg;
  Camera c;
  c.towards = {-std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  c.right = Eigen::Vector3d::UnitZ().cross(c.towards).normalized();
  c.up = c.towards.cross(c.right);
  return c;
}

struct Facet {
  std::array<Eigen::Vector2d, 4> corners;
  double depth = 0;
  std::string fill;
};

std::string shade(const char* base, double light) {
  const auto rgb = std::stoul(base + 1, nullptr, 16);
  const double k = 0.74 + 0.26 * light;
  const auto channel = [&](unsigned shift) { return static_cast<int>(static_cast<double>((rgb >> shift) & 0xFF) * k); };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(16), channel(8), channel(0));
}

/// The held surface of a ring; a sun is held at its bore, which the teeth hide. Of two held end faces the lower one
/// shows.
std::optional<Boundary> held_boundary(const fem::LoadedMeshProblem& problem) {
  if (!problem.pair.internal()) return std::nullopt;
  switch (problem.structure.body(problem.wheel_support_radius).held) {
    case fem::HeldSurface::outside:
      return Boundary::support;
    case fem::HeldSurface::low_end_face:
    case fem::HeldSurface::both_end_faces:
      return Boundary::end_low;
    case fem::HeldSurface::flange_face:
      return Boundary::flange_face;
    case fem::HeldSurface::none:
      break;
  }
  return std::nullopt;
}

std::vector<Facet> facets(const Mesh& mesh, const Camera& eye, std::optional<Boundary> held) {
  const Eigen::Vector3d lamp = (eye.towards + 0.5 * eye.up - 0.6 * eye.right).normalized();
  std::vector<Facet> list;
  for (const auto& face : mesh.faces) {
    std::array<Eigen::Vector3d, 4> p;
    for (std::size_t i = 0; i < 4; ++i) p[i] = mesh.vertices[face.vertices[i]];
    const Eigen::Vector3d normal = (p[2] - p[0]).cross(p[3] - p[1]).normalized();
    if (normal.dot(eye.towards) <= 0) continue;
    Facet facet;
    const Eigen::Vector3d middle = (p[0] + p[1] + p[2] + p[3]) / 4;
    facet.depth = middle.dot(eye.towards);
    for (std::size_t i = 0; i < 4; ++i)
      facet.corners[i] = {p[i].dot(eye.right) / units::mm, -p[i].dot(eye.up) / units::mm};
    const char* colour = face.boundary == held                      ? held_colour
                         : face.boundary == Boundary::leading_flank ? planet_fill
                                                                    : wheel_fill;
    facet.fill = shade(colour, std::clamp(normal.dot(lamp), 0.0, 1.0));
    list.push_back(std::move(facet));
  }
  std::sort(list.begin(), list.end(), [](const Facet& a, const Facet& b) { return a.depth < b.depth; });
  return list;
}

std::string solid_picture(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshResult& solved) {
  constexpr std::size_t most_drawn_faces = 30000;  // keeps the document below two megabytes
  const auto& sector = solved.wheel_sector;
  const int wanted =
      sector.faces.size() > most_drawn_faces / 5 ? (sector.faces.size() > most_drawn_faces / 3 ? 1 : 3) : 5;
  const Mesh mesh = wanted == 1 ? sector : geometry::repeat(sector, problem.pair.wheel().teeth(), wanted);
  const auto list = facets(mesh, camera(), held_boundary(problem));
  Eigen::AlignedBox2d box;
  for (const auto& facet : list) {
    for (const auto& corner : facet.corners) box.extend(corner);
  }
  const Eigen::Vector2d low = box.min() - Eigen::Vector2d(3, 3), size = box.sizes() + Eigen::Vector2d(6, 6);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.2f} {:.2f} {:.2f} {:.2f}\" role=\"img\" "
      "aria-label=\"mesh\">"
      "<g stroke=\"#5a6a78\" stroke-width=\"0.06\" stroke-linejoin=\"round\">",
      low.x(), low.y(), size.x(), size.y());
  for (const auto& facet : list) {
    const auto& c = facet.corners;
    svg += fmt::format("<path fill=\"{}\" d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}L{:.2f} {:.2f}L{:.2f} {:.2f}Z\"/>",
                       facet.fill, c[0].x(), c[0].y(), c[1].x(), c[1].y(), c[2].x(), c[2].y(), c[3].x(), c[3].y());
  }
  return svg + "</g></svg>";
}

}  // namespace

std::string mesh_picture(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshResult& solved,
                         const std::string& name) {
  return solved.wheel_sector.dimension == 2 ? plane_picture(problem, solved, name) : solid_picture(problem, solved);
}

}  // namespace annulus::app
