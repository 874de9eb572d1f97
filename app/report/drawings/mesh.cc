#include "app/report/drawings/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "app/report/drawings/drawing_page.h"
#include "app/report/drawings/facets.h"
#include "app/report/drawings/support.h"
#include "core/units.h"
#include "geometry/gear_places.h"

namespace annulus::app {

namespace {

using geometry::Boundary;
using geometry::Mesh;

const DrawingPage mesh_page{.scale = 1 / units::mm};

/// The teeth of a body in the plane are copies of one sector, which is written once and used again.
struct TeethCopies {
  std::string id;
  const char* fill;
  double pitch, first;  ///< rad
  double centre;        ///< m, along the line of centres
};
std::string teeth(const Mesh& sector, const TeethCopies& copies, int each_side, double pen) {
  const auto place = [&](std::size_t v) { return Eigen::Vector2d(sector.vertices[v].head<2>()); };
  std::string cells, outline;
  for (const auto& c : sector.cells)
    cells += mesh_page.through({place(c[0]), place(c[1]), place(c[2]), place(c[3])}) + "Z";
  // Without the cuts to its neighbours.
  for (const auto& face : sector.faces)
    if (face.boundary != Boundary::side_low && face.boundary != Boundary::side_high)
      outline += mesh_page.through({place(face.vertices[0]), place(face.vertices[1])});
  std::string text = fmt::format(
      "<defs><g id=\"{}\"><path d=\"{}\" fill=\"{}\" stroke=\"#46586a\" stroke-opacity=\"0.6\" "
      "stroke-width=\"{:.3g}\"/><path d=\"{}\" fill=\"none\" stroke=\"#2c3a48\" stroke-width=\"{:.3g}\" "
      "stroke-linecap=\"round\"/></g></defs>",
      copies.id, cells, copies.fill, 0.025 * pen, outline, 0.22 * pen);
  // On the page the y axis points down and x became upright: a counter-clockwise angle turns by minus the angle.
  for (int i = -each_side; i <= each_side; ++i)
    text += fmt::format("<use href=\"#{}\" transform=\"translate(0 {:.3f}) rotate({:.5f})\"/>", copies.id,
                        -copies.centre / units::mm, -(copies.first + i * copies.pitch) / units::deg);
  return text;
}

std::string plane_picture(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshResult& solved,
                          const std::string& name) {
  const auto& pair = problem.pair;
  const auto &pinion = pair.pinion(), &wheel = pair.wheel();
  const double centre = pair.centre_distance(), support = problem.wheel_support_radius;
  const auto [pinion_first, wheel_first] = geometry::pair_places(pair);  // pitch-point contact
  const double wheel_pitch = wheel.base_radius() / std::cos(pair.working_pressure_angle());

  constexpr int each_side = 4;
  const double half_width = 3.4 * wheel.pitch_angle() * wheel_pitch;
  const double low = pair.internal() ? centre + problem.pinion_bore_radius : support;
  const double high = pair.internal() ? support : centre - problem.pinion_bore_radius;
  const double margin = support_margin(problem.structure, support);
  const double pen = pinion.parameters().module / (3.8 * units::mm);  // lines as thick for the eye, whatever the size
  std::string text =
      teeth(solved.wheel_sector, {"wheel-" + name, wheel_fill, wheel.pitch_angle(), wheel_first, 0}, each_side, pen);
  text += teeth(solved.pinion_sector, {"pinion-" + name, planet_fill, pinion.pitch_angle(), pinion_first, centre},
                each_side, pen);
  const double reach = (each_side + 0.5) * wheel.pitch_angle();
  text += pair.internal() ? drawn_supports(mesh_page, problem.structure, support, wheel_first, reach)
                          : held_arc(mesh_page, support, wheel_first, reach);
  text += svg::circle({0, -wheel_pitch / units::mm}, 0.9 * pen,
                      fmt::format(R"(fill="none" stroke="#000" stroke-width="{:.3g}")", 0.35 * pen));
  return svg::picture("mesh", svg::Point(-half_width, -(high + margin)) / units::mm,
                      svg::Point(2 * half_width, high - low + 2 * margin) / units::mm, text);
}

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

/// A few teeth of the wheel in parallel projection.
std::string solid_picture(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshResult& solved) {
  constexpr std::size_t most_drawn_faces = 30000;  // keeps the document below two megabytes
  const auto& sector = solved.wheel_sector;
  const int wanted =
      sector.faces.size() > most_drawn_faces / 5 ? (sector.faces.size() > most_drawn_faces / 3 ? 1 : 3) : 5;
  const Mesh mesh = wanted == 1 ? sector : geometry::repeat(sector, problem.pair.wheel().teeth(), wanted);
  const auto held = held_boundary(problem);
  const Eigen::Matrix3d axes = eye_axes() / units::mm;
  const Eigen::Vector3d lamp = Eigen::Vector3d(-0.6, 0.5, 1).normalized();
  FacetPicture picture{.label = "mesh", .edge = "#5a6a78", .edge_width = 0.0005};
  for (const auto& face : mesh.faces) {
    Facet facet;
    for (std::size_t i = 0; i < 4; ++i) facet.corners[i] = axes * mesh.vertices[face.vertices[i]];
    const Eigen::Vector3d normal = facet.normal().normalized();
    if (normal.z() <= 0) continue;
    const char* colour = face.boundary == held                      ? held_colour
                         : face.boundary == Boundary::leading_flank ? planet_fill
                                                                    : wheel_fill;
    facet.fill = shade(colour, std::clamp(normal.dot(lamp), 0.0, 1.0));
    picture.facets.push_back(facet);
  }
  sort_by_depth(picture.facets);
  return to_svg(picture);
}

}  // namespace

std::string mesh_picture(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshResult& solved,
                         const std::string& name) {
  return solved.wheel_sector.dimension == 2 ? plane_picture(problem, solved, name) : solid_picture(problem, solved);
}

}  // namespace annulus::app
