#include "geometry/sector_mesh.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "gears.h"
#include "tests/verification_record.h"

namespace annulus::geometry::test {

namespace {

/// Area left of the boundary faces: equals the area of the cells when the faces close around them.
double area_by_faces(const Mesh& mesh) {
  double area = 0;
  for (const auto& face : mesh.faces) {
    const auto& a = mesh.vertices[face.vertices[0]];
    const auto& b = mesh.vertices[face.vertices[1]];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

/// Exact area of the sector: half the tooth outline as a fine polygon, the circular parts in closed form.
double exact_area(const Gear& gear, double support) {
  const ToothProfile profile(gear);
  const double sign = gear.kind() == GearKind::external ? 1 : -1;
  // Walking from the tip to the root, the area between the axis and the outline, counted positive.
  double area = 0;
  const auto add = [&](const auto& curve) {
    constexpr int parts = 4000;  // error of the chords: (1/4000)^2 / 8 of the area swept
    for (int i = 0; i < parts; ++i) {
      const Eigen::Vector2d a = curve(static_cast<double>(i) / parts);
      const Eigen::Vector2d b = curve((i + 1.0) / parts);
      area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
  };
  const double tip = profile.roll_length_tip();
  const double form = profile.roll_length_form();
  add([&](double t) { return profile.flank_point(tip + t * (form - tip)); });
  add([&](double t) { return profile.fillet_point(t); });
  const Eigen::Vector2d corner = profile.flank_point(tip);
  const Eigen::Vector2d end = profile.fillet_point(1);
  area += 0.5 * std::pow(gear.tip_radius(), 2) * std::atan2(corner.y(), corner.x());
  area += 0.5 * std::pow(gear.root_radius(), 2) * (gear.pitch_angle() / 2 - std::atan2(end.y(), end.x()));
  return 2 * sign * (area - 0.5 * support * support * gear.pitch_angle() / 2);
}

void check_sector(const Mesh& mesh, const Gear& gear, const Rim& rim) {
  const ToothProfile profile(gear);
  std::map<double, Eigen::Vector2d> low;
  std::map<double, Eigen::Vector2d> high;
  double off_curve = 0;
  for (const auto& face : mesh.faces) {
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d v = mesh.vertices[face.vertices[i]].head<2>();
      off_curve = std::max(off_curve, (profile.project(face.boundary, v, rim.support_radius) - v).norm());
      if (face.boundary == Boundary::side_low) low[v.norm()] = v;
      if (face.boundary == Boundary::side_high) high[v.norm()] = v;
    }
  }
  BOOST_TEST(off_curve < 1e-12);  // m, what `project` promises
  BOOST_REQUIRE(low.size() == high.size());
  double mismatch = 0;
  for (auto l = low.begin(), h = high.begin(); l != low.end(); ++l, ++h) {
    mismatch = std::max(mismatch, (Eigen::Rotation2Dd(gear.pitch_angle()) * l->second - h->second).norm());
  }
  BOOST_TEST(mismatch < 1e-12);
  // Faces and cells tell the same area: no gap, no double face, right orientation. Rounding of cancelling r^2 terms.
  const double scale = std::pow(std::max(gear.tip_radius(), rim.support_radius), 2) * gear.pitch_angle();
  BOOST_TEST(std::abs(area_by_faces(mesh) - mesh.area_or_volume()) < 1e-12 * scale);
  for (const double circle : rim.circles) {
    const auto on_circle = [&](const Eigen::Vector3d& v) { return std::abs(v.norm() - circle) < 1e-9; };
    BOOST_TEST(std::ranges::count_if(mesh.vertices, on_circle) > 4);
  }
}

/// Fractions whose cells grow by 1.25 from `smallest` at `centre` to a twentieth.
std::vector<double> refined_towards(double centre, double smallest) {
  std::vector<double> fractions{centre};
  for (const int direction : {-1, 1}) {
    const double end = direction > 0 ? 1 : 0;
    double cell = smallest;
    for (double at = centre; at != end; cell = std::min(1.25 * cell, 0.05)) {
      at += direction * cell;
      if (direction * (end - at) < 0.6 * cell) at = end;
      fractions.push_back(at);
    }
  }
  std::ranges::sort(fractions);
  return fractions;
}

std::vector<Eigen::Vector3d> boundary_vertices(const Mesh& mesh, Boundary boundary) {
  std::map<std::uint32_t, Eigen::Vector3d> found;
  for (const auto& face : mesh.faces) {
    if (face.boundary != boundary) continue;
    for (int i = 0; i < 2; ++i) found[face.vertices[i]] = mesh.vertices[face.vertices[i]];
  }
  std::vector<Eigen::Vector3d> vertices;
  for (const auto& [index, v] : found) vertices.push_back(v);
  std::ranges::sort(vertices, {}, [](const Eigen::Vector3d& v) { return v.squaredNorm(); });
  return vertices;
}

/// Roll lengths of the vertices of a flank from the form circle to the tip.
std::vector<double> flank_rolls(const Mesh& mesh, const ToothProfile& profile, Boundary flank) {
  std::vector<double> rolls;
  for (const auto& v : boundary_vertices(mesh, flank)) rolls.push_back(profile.roll_length_at(v.norm()));
  if (profile.gear().kind() == GearKind::internal) std::ranges::reverse(rolls);
  return rolls;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(sector_mesh)

BOOST_AUTO_TEST_CASE(no_bad_cells_over_the_range_of_legal_geometry) {
  std::mt19937 generator(20240501);
  const auto uniform = [&](double a, double b) { return a + (b - a) * (generator() / 4294967296.0); };
  double worst = 1;
  std::string worst_case;
  int legal = 0;
  int drawn = 0;
  while (legal < 240) {
    ++drawn;
    BOOST_REQUIRE(drawn < 2000);
    const bool internal = drawn % 2 == 0;
    auto p = plain_gear(internal ? GearKind::internal : GearKind::external, 0, uniform(-0.5, 1.0));
    // Half of the gears from the low end of the range, where the flanks are most curved.
    const double spread = std::pow(uniform(0, 1), 2);
    p.teeth = static_cast<int>(internal ? 40 + 210 * spread : 17 + 183 * spread);
    p.pressure_angle = uniform(14.5, 30) * units::deg;
    p.root_fillet_factor = uniform(0.1, 0.45);
    p.helix_angle = uniform(0, 1) < 0.3 ? uniform(-35, 35) * units::deg : 0;
    if (drawn % 4 < 2) p.tip_chamfer = 0.15 * p.module;
    if (!internal && drawn % 6 < 3) {
      p.protuberance = 0.03 * p.module;
      p.protuberance_angle = p.pressure_angle / 2;
    }
    const double thickness = uniform(1, 8) * p.module;
    const bool circle = uniform(0, 1) < 0.5;
    const double circle_depth = uniform(min_circle_distance, 0.9 * thickness / p.module) * p.module;
    const double fineness = uniform(0, 1);
    const auto between = [&](int coarse, int fine) {
      return coarse + static_cast<int>(fineness * (fine - coarse) + 0.5);
    };
    const SectorResolution resolution{.flank_cells = between(6, 60),
                                      .fillet_cells = 2 * between(1, 4),
                                      .thickness_cells = between(4, 20),
                                      .root_cells = between(1, 4),
                                      .rim_cells = between(2, 10),
                                      .flank_layer = uniform(0.1, 1)};
    std::optional<Gear> gear;
    try {
      gear.emplace(p);
    } catch (const GeometryError&) {
      continue;  // undercut, pointed or without involute: not legal
    }
    const double sign = internal ? 1 : -1;
    Rim rim{.support_radius = gear->root_radius() + sign * thickness};
    if (!internal && rim.support_radius < 0.2 * gear->root_radius()) continue;  // no bore left
    if (circle) rim.circles.push_back(gear->root_radius() + sign * circle_depth);
    ++legal;
    const std::string label = fmt::format(
        "{} teeth, {}, x {:.4f}, {:.3f} deg, helix {:.3f} deg, fillet {:.3f}, rim {:.3f} modules, circle {:.3f} "
        "modules deep",
        p.teeth, internal ? "internal" : "external", p.profile_shift, p.pressure_angle / units::deg,
        p.helix_angle / units::deg, p.root_fillet_factor, thickness / p.module, circle ? circle_depth / p.module : 0.0);
    BOOST_TEST_CHECKPOINT(label);
    const Mesh mesh = make_sector_mesh(*gear, rim, resolution);
    check_sector(mesh, *gear, rim);
    const double quality = mesh.worst_scaled_jacobian();
    if (quality < worst) {
      worst = quality;
      worst_case = label;
    }
  }
  annulus::test::Verification record("Cells of 240 random legal gears and rims", "bound on the scaled Jacobian");
  BOOST_TEST_MESSAGE("worst scaled Jacobian of " << legal << " sectors: " << worst << " (" << worst_case << ")");
  record.at_least("worst scaled Jacobian", "", worst, 0.3, "the usual limit for a well-conditioned quadrilateral");
}

BOOST_AUTO_TEST_CASE(area_converges_to_the_exact_area_with_second_order) {
  annulus::test::Verification record("Area of the mesh of a tooth sector",
                                     "exact area of the outline, integrated along its curves");
  for (const Gear& gear : {paper_planet(), paper_ring()}) {
    const double support = gear.kind() == GearKind::external ? 86 * units::mm : 331.8 * units::mm;
    const double exact = exact_area(gear, support);
    std::vector<double> errors;
    for (const int n : {1, 2, 4}) {
      const Mesh mesh = make_sector_mesh(gear, {.support_radius = support},
                                         {.flank_cells = 8 * n,
                                          .fillet_cells = 4 * n,
                                          .thickness_cells = 4 * n,
                                          .root_cells = n,
                                          .rim_cells = 3 * n,
                                          .flank_layer = 1});
      errors.push_back(std::abs(mesh.area_or_volume() / exact - 1));
    }
    BOOST_TEST_MESSAGE("relative area errors " << errors[0] << " " << errors[1] << " " << errors[2]);
    const auto* name = gear.kind() == GearKind::external ? "planet" : "ring";
    record.at_least(std::string("order of convergence, ") + name, "", std::log2(errors[1] / errors[2]), 1.8,
                    "0.9 of the order 2 of chords");
    record.at_most(std::string("relative error of the finest mesh, ") + name, "", errors[2], 1e-4,
                   "ceiling beside the rate");
    record.convergence("Error of the area; dashed: order 2", "size of a cell, relative", "relative error", name,
                       {1, 0.5, 0.25}, errors, 2);
  }
}

BOOST_AUTO_TEST_CASE(the_resolution_is_what_was_asked_for) {
  annulus::test::Verification record("Numbers and sizes of the cells of a tooth sector",
                                     "counted by hand from the wanted resolution; arc length of the involute");
  const Gear gear = paper_ring();
  const SectorResolution n{
      .flank_cells = 12, .fillet_cells = 4, .thickness_cells = 7, .root_cells = 2, .rim_cells = 5, .flank_layer = 0.25};
  const Mesh mesh = make_sector_mesh(gear, {.support_radius = 0.3318, .circles = {0.322}}, n);
  std::map<Boundary, int> faces;
  for (const auto& face : mesh.faces) ++faces[face.boundary];
  const auto counted = [&](const std::string& what, double found, double wanted) {
    record.near(what, "", found, wanted, 0, "counted by hand");
  };
  counted("faces of a flank", faces[Boundary::leading_flank], 12);
  counted("faces of a flank", faces[Boundary::trailing_flank], 12);
  counted("faces of a fillet", faces[Boundary::leading_fillet], 4);
  counted("faces of a fillet", faces[Boundary::trailing_fillet], 4);
  counted("faces of the tip", faces[Boundary::tip], 7);
  counted("faces of the root", faces[Boundary::root], 4);
  counted("faces of a side", faces[Boundary::side_low], 5);
  counted("faces of a side", faces[Boundary::side_high], 5);
  counted("faces of the support", faces[Boundary::support], 7 + 4 + 4);
  counted("cells", static_cast<double>(mesh.cells.size()), 7 * (12 + 2) + 5 * 15);
  counted("cells of the tooth", static_cast<double>(std::ranges::count(mesh.regions, Mesh::Region::tooth)), 7 * 14);

  // Flank cells are uniform in arc length rho^2 / 2 r_b, the layer under the flanks is a quarter of a uniform cell.
  const ToothProfile profile(gear);
  double shortest = 1;
  double longest = 0;
  double tip_cell = 1;
  for (const auto& face : mesh.faces) {
    const auto& a = mesh.vertices[face.vertices[0]];
    const auto& b = mesh.vertices[face.vertices[1]];
    const double arc = std::abs(a.squaredNorm() - b.squaredNorm()) / (2 * gear.base_radius());
    if (face.boundary == Boundary::leading_flank) {
      shortest = std::min(shortest, arc);
      longest = std::max(longest, arc);
    }
    if (face.boundary == Boundary::tip) tip_cell = std::min(tip_cell, (a - b).norm());
  }
  record.near("longest over shortest cell of a flank", "", longest / shortest, 1, 1e-9,
              "rounding of differences of r^2");
  BOOST_TEST(longest / shortest < 1 + 1e-9);
  // The chord of the first cell is shorter than its arc by 1e-7 of it.
  const double uniform_cell = gear.tooth_thickness(gear.tip_radius()) / 7;
  record.close("first cell under a flank at the tip", "m", tip_cell, 0.25 * uniform_cell, 1e-6,
               "chord against arc: 1e-7 of it");
}

BOOST_AUTO_TEST_CASE(flank_vertices_lie_where_they_are_wanted) {
  annulus::test::Verification record("Vertices of refined flanks",
                                     "squares of roll lengths at the wanted fractions of the arc");
  struct Body {
    Gear gear;
    double support;
  };
  const std::vector<Body> bodies{
      {paper_sun(), 70 * units::mm}, {paper_planet(), 86 * units::mm}, {paper_ring(), 331.8 * units::mm}};
  double worst = 1;
  for (const auto& [gear, support] : bodies) {
    const ToothProfile profile(gear);
    const Mesh uniform = make_sector_mesh(gear, {.support_radius = support}, {.thickness_cells = 40});
    // Towards the tip, the form circle and points between them, with and without thin layers under the flank.
    for (const auto& [centre, smallest] : {std::pair{1.0, 1 / 2000.}, {0.0, 1 / 2000.}, {0.37, 1e-3}, {0.97, 1e-3}}) {
      for (const auto& [cells, layer] : {std::pair{14, 1.0}, {20, 0.02}, {60, 0.02}, {20, 0.001}, {60, 0.001}}) {
        const auto fractions = refined_towards(centre, smallest);
        const Mesh mesh =
            make_sector_mesh(gear, {.support_radius = support},
                             {.thickness_cells = cells, .flank_layer = layer, .flank_fractions = fractions});
        worst = std::min(worst, mesh.worst_scaled_jacobian());
        for (const auto flank : {Boundary::leading_flank, Boundary::trailing_flank}) {
          const auto found = flank_rolls(mesh, profile, flank);
          BOOST_REQUIRE(found.size() == fractions.size());
          for (std::size_t i = 0; i < found.size(); ++i) {
            const double form = std::pow(profile.roll_length_form(), 2);
            const double wanted = form + fractions[i] * (std::pow(profile.roll_length_tip(), 2) - form);
            // rho^2 = r^2 - r_b^2 carries the rounding of r^2.
            record.at_most("squared roll length over the tip radius, difference", "m",
                           std::abs(found[i] * found[i] - wanted) / gear.tip_radius(), 1e-15, "rounding of r^2");
          }
        }
        if (cells != 20) continue;
        check_sector(mesh, gear, {.support_radius = support});
        // The radial cuts are those of any other fractions.
        const Mesh other = make_sector_mesh(gear, {.support_radius = support},
                                            {.flank_cells = 11, .thickness_cells = cells, .flank_layer = 0.3});
        for (const auto side : {Boundary::side_low, Boundary::side_high}) {
          BOOST_TEST((boundary_vertices(mesh, side) == boundary_vertices(other, side)));
        }
      }
    }
  }
  BOOST_TEST_MESSAGE("worst scaled Jacobian with refined flanks: " << worst);
  record.at_least("worst scaled Jacobian", "", worst, 0.8,
                  "tip corner and middle of the fillets");  // only the tip corner and the middle of the fillets are far
                                                            // from right angles

  SectorResolution wrong;
  for (const auto& fractions : {std::vector<double>{0, 0.5, 0.5, 1}, {0.1, 1}, {0, 0.9}, {0, 0.6, 0.4, 1}, {0}}) {
    wrong.flank_fractions = fractions;
    BOOST_CHECK_THROW((void)make_sector_mesh(paper_ring(), {.support_radius = 0.3318}, wrong), InternalError);
  }
}

BOOST_AUTO_TEST_CASE(layers_grow_geometrically_from_both_flanks) {
  annulus::test::Verification record("Thin layers of cells under the flanks",
                                     "geometric progression from the wanted layer, equal on both sides");
  const Gear gear = paper_planet();
  for (const auto& [cells, layer] : {std::pair{20, 0.02}, {21, 0.1}, {40, 0.001}, {3, 0.5}}) {
    const Mesh mesh =
        make_sector_mesh(gear, {.support_radius = 0.086}, {.thickness_cells = cells, .flank_layer = layer});
    std::vector<double> angles;
    for (const auto& v : boundary_vertices(mesh, Boundary::tip)) angles.push_back(std::atan2(v.y(), v.x()));
    std::ranges::sort(angles);
    BOOST_REQUIRE(static_cast<int>(angles.size()) == cells + 1);
    const auto size = [&](int i) { return angles[i + 1] - angles[i]; };
    const double whole = 2 * gear.tooth_half_angle(gear.tip_radius());
    const double rounding = 1e-9;  // differences of angles, 1e-17, against the thinnest layer, 1e-6
    record.close("angle of the first layer", "rad", size(0), layer * whole / cells, rounding, "rounding of angles");
    for (int i = 0; i < cells / 2; ++i) {
      record.close("layer over the one on the other side", "", size(i) / size(cells - 1 - i), 1, rounding,
                   "rounding of angles");
      if (i > 0)
        record.close("growth over that of the first layer", "", size(i) / size(i - 1) / (size(1) / size(0)), 1,
                     rounding, "rounding of angles");
    }
  }
}

BOOST_AUTO_TEST_CASE(meshing_twice_gives_the_same_mesh) {
  const Rim rim{.support_radius = 0.3318};
  const Mesh first = make_sector_mesh(paper_ring(), rim, {});
  const Mesh second = make_sector_mesh(paper_ring(), rim, {});
  BOOST_REQUIRE(first.vertices.size() == second.vertices.size());
  BOOST_REQUIRE(first.cells.size() == second.cells.size());
  int vertices = 0, cells = 0;
  for (std::size_t i = 0; i < first.vertices.size(); ++i) vertices += first.vertices[i] != second.vertices[i];
  for (std::size_t i = 0; i < first.cells.size(); ++i) cells += first.cells[i] != second.cells[i];
  annulus::test::Verification record("A tooth sector meshed twice", "each other");
  record.at_most("vertices that differ", "", vertices, 0, "equal to the last bit");
  record.at_most("cells that differ", "", cells, 0, "equal");
}

BOOST_AUTO_TEST_CASE(impossible_rims_are_refused_with_the_reason) {
  const auto refuse = [](const Gear& gear, const Rim& rim, const std::string& part) {
    check_refused([&] { (void)make_sector_mesh(gear, rim, {}); }, part);
  };
  refuse(paper_ring(), {.support_radius = 0.310}, "no rim");
  refuse(paper_planet(), {.support_radius = 0.103}, "no rim");
  refuse(paper_planet(), {.support_radius = -0.01}, "no rim");
  refuse(paper_ring(), {.support_radius = 0.3318, .circles = {0.3132}}, "mesh circle");
  refuse(paper_ring(), {.support_radius = 0.3318, .circles = {0.34}}, "mesh circle");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::geometry::test
