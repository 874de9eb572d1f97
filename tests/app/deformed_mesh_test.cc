#include "app/report/drawings/deformed_mesh.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "app/systems/planetary/planetary_run.h"
#include "core/log.h"
#include "tests/app/scenes.h"

namespace annulus {

namespace {

using Eigen::Vector2d;

Vector2d moved(const app::DeformedMesh& view, std::size_t v, double times) {
  return {view.place_mm[3 * v] + times * view.displacement_mm[3 * v],
          view.place_mm[3 * v + 1] + times * view.displacement_mm[3 * v + 1]};
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// mm by which a point lies inside a quadrilateral; negative: outside.
double depth_in(const Vector2d& p, const std::array<Vector2d, 4>& corners) {
  double depth = std::numeric_limits<double>::infinity(), area = 0;
  for (std::size_t i = 0; i < 4; ++i) area += cross(corners[i], corners[(i + 1) % 4]);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d edge = corners[(i + 1) % 4] - corners[i];
    depth = std::min(depth, std::copysign(1.0, area) * cross(edge, p - corners[i]) / edge.norm());
  }
  return depth;
}

/// Which vertices belong to the planet: pieces of connected faces that reach into the planet's rim, beyond which no
/// tooth of the wheel comes.
std::vector<bool> of_planet(const app::DeformedMesh& view, const geometry::GearPair& pair) {
  std::vector<std::size_t> piece(view.stress_MPa.size());
  std::iota(piece.begin(), piece.end(), std::size_t{0});
  const auto root = [&](std::size_t v) {
    while (piece[v] != v) v = piece[v] = piece[piece[v]];
    return v;
  };
  for (std::size_t f = 0; f < view.faces.size(); f += 4)
    for (std::size_t i = 1; i < 4; ++i) piece[root(view.faces[f + i])] = root(view.faces[f]);
  const double mm = 1e3, rim = mm * pair.pinion().root_radius() - 1e-3;
  std::vector<bool> inner(piece.size(), false), result(piece.size());
  for (std::size_t v = 0; v < piece.size(); ++v)
    if ((moved(view, v, 0) - Vector2d(0, mm * pair.centre_distance())).norm() < rim) inner[root(v)] = true;
  for (std::size_t v = 0; v < piece.size(); ++v) result[v] = inner[root(v)];
  return result;
}

/// mm by which any vertex of the planet stands deepest in a cell of the wheel, and the smallest distance of two
/// vertices, one of each.
struct Touch {
  double depth = -std::numeric_limits<double>::infinity(), distance = std::numeric_limits<double>::infinity();
};
Touch touch(const app::DeformedMesh& view, const std::vector<bool>& planet, double times) {
  Touch found;
  for (std::size_t v = 0; v < planet.size(); ++v) {
    if (!planet[v]) continue;
    const auto p = moved(view, v, times);
    for (std::size_t f = 0; f < view.faces.size(); f += 4) {
      if (planet[view.faces[f]]) continue;
      std::array<Vector2d, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) corners[i] = moved(view, view.faces[f + i], times);
      if ((corners[0] - p).norm() > 3) continue;  // far away
      found.depth = std::max(found.depth, depth_in(p, corners));
      for (const auto& c : corners) found.distance = std::min(found.distance, (c - p).norm());
    }
  }
  return found;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(deformed_mesh)

/// The flanks of both bodies touch as they stand and at every exaggeration. Their displacements, some 10 µm, would
/// drive them into each other, or apart, without the rotation of the planet under the load. What is left is the sag of
/// straight edges of cells under curved flanks and the local flattening of the contact.
BOOST_AUTO_TEST_CASE(flanks_touch_at_every_exaggeration) {
  const test::TemporaryFolder folder("deformed_mesh");
  log::set_level(log::Level::quiet);
  const auto result = app::run(app::parse_scene(test::small_stage(), "scene.toml"),
                               {.out = folder.path(), .threads = 2, .with_dynamics = false});
  for (const auto* mesh : {&result.sun_mesh, &result.rings.front().mesh}) {
    BOOST_TEST_REQUIRE(mesh->fields.size() == 1U);
    const auto& view = mesh->fields.front();
    BOOST_TEST_REQUIRE(!view.solid);
    const auto planet = of_planet(view, mesh->model.problem->pair);
    BOOST_TEST(std::count(planet.begin(), planet.end(), true) > 500);
    BOOST_TEST(std::count(planet.begin(), planet.end(), false) > 500);
    const double um = 1e-3;
    const double largest = view.largest_displacement_mm;
    BOOST_TEST(largest > 5 * um);
    for (const double times : {0.0, 1.0, 10.0}) {
      const auto found = touch(view, planet, times);
      BOOST_TEST_MESSAGE(view.name << " x" << times << ": depth " << found.depth / um << " µm, distance "
                                   << found.distance / um << " µm, largest displacement " << largest / um);
      BOOST_TEST(found.depth < 2 * um + 0.15 * times * largest);
      BOOST_TEST(found.distance < 0.5);
    }
  }
}

BOOST_AUTO_TEST_CASE(views_share_their_colours) {
  app::DeformedMesh a, b;
  a.top_MPa = 230;
  b.top_MPa = 410;
  app::share_colours({&a, &b});
  BOOST_TEST(a.top_MPa == b.top_MPa);
  BOOST_TEST(a.top_MPa >= 410);
  BOOST_TEST(a.top_MPa <= 600);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
