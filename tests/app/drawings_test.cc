#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <regex>

#include "app/report/drawings/axial_section.h"
#include "app/report/drawings/dimension.h"
#include "app/report/drawings/teeth.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "app/systems/planetary/ring_structures.h"
#include "core/units.h"
#include "tests/app/scenes.h"
#include "tests/geometry/polygons.h"

/// The drawings read back from their SVG: what a reader measures on the page.
namespace annulus {

namespace {

using test::Polyline;

/// Something placed on the page.
struct Use {
  Eigen::Vector2d at{0, 0};
  double angle = 0;  ///< rad, as on the page: positive clockwise
};

/// All <use> elements of an identifier in a piece of SVG.
std::vector<Use> uses(const std::string& svg, const std::string& id) {
  static const std::string number = "(-?[0-9.]+)";
  const std::regex use("<use href=\"#" + id + "\" transform=\"(?:translate\\(" + number + " " + number +
                       "\\) )?rotate\\(" + number + "\\)\"/>");
  std::vector<Use> list;
  for (std::sregex_iterator at(svg.begin(), svg.end(), use), end; at != end; ++at) {
    Use found{{0, 0}, std::stod((*at)[3]) * units::deg};
    if ((*at)[1].matched) found.at = {std::stod((*at)[1]), std::stod((*at)[2])};
    list.push_back(found);
  }
  return list;
}

std::string attribute(const std::string& svg, const std::string& element, const std::string& name) {
  const auto at = svg.find(element);
  BOOST_TEST_REQUIRE(at != std::string::npos, element << " is missing");
  const auto begin = svg.find(" " + name + "=\"", at) + name.size() + 3;
  return svg.substr(begin, svg.find('"', begin) - begin);
}

/// The outline of a tooth as drawn.
Polyline tooth(const std::string& svg, const std::string& id) {
  Polyline points;
  const std::string d = attribute(svg, "<path id=\"outline-" + id + "\"", "d");
  for (std::size_t at = 0; at < d.size();) {
    std::size_t used = 0;
    const double x = std::stod(d.substr(at + 1), &used);
    const std::size_t second = at + 1 + used;
    const double y = std::stod(d.substr(second), &used);
    points.emplace_back(x, y);
    at = second + used;
  }
  return points;
}

/// Every gear of an identifier as a closed outline on the page.
std::vector<Polyline> gears(const std::string& svg, const std::string& id) {
  const auto outline = tooth(svg, id);
  const auto teeth = uses(svg, "tooth-" + id);
  std::vector<Polyline> all;
  for (const auto& place : uses(svg, "gear-" + id)) {
    Polyline gear;
    for (const auto& use : teeth)
      for (const auto& p : outline) gear.push_back(test::moved(p, place.at, place.angle + use.angle));
    all.push_back(std::move(gear));
  }
  return all;
}

std::string stage_svg(const std::string& scene_text, std::size_t ring = 0) {
  const auto scene = app::parse_scene(scene_text, "s");
  return app::to_svg(app::stage_section(scene, app::make_geometry(scene), ring, "t"));
}

/// Page units per mm by the scale bar.
double scale_of(const std::string& svg) {
  static const std::regex bar("v-7m0 3.5h([0-9.]+)m0 -3.5v7.*?>([0-9.]+) mm</text>");
  std::smatch match;
  BOOST_TEST_REQUIRE(std::regex_search(svg, match, bar));
  return std::stod(match[1]) / std::stod(match[2]);
}

constexpr double drawn_to = 0.1;  // page units (a tenth of a pixel): coordinates are rounded to a hundredth

std::size_t times(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(drawings)

BOOST_AUTO_TEST_CASE(drawn_gears_touch_and_do_not_overlap) {
  struct Case {
    std::string text;
    std::size_t sun, planet, ring, planets;
    double distance_mm, module_mm;
  };
  for (const auto& c :
       {Case{test::quick_scene(), 48, 55, 162, 5, 201, 3.8}, Case{test::small_stage(), 24, 24, 72, 4, 96, 4}}) {
    const auto svg = stage_svg(c.text);
    const double scale = scale_of(svg);
    BOOST_TEST(uses(svg, "tooth-t-sun").size() == c.sun);
    BOOST_TEST(uses(svg, "tooth-t-planet").size() == c.planet);
    BOOST_TEST(uses(svg, "tooth-t-ring").size() == c.ring);
    const auto sun = gears(svg, "t-sun"), planets = gears(svg, "t-planet"), ring = gears(svg, "t-ring");
    BOOST_TEST_REQUIRE(planets.size() == c.planets);
    const auto axis = uses(svg, "gear-t-sun").front().at;
    const auto places = uses(svg, "gear-t-planet");
    const double pitch = c.distance_mm * static_cast<double>(c.sun) / static_cast<double>(c.sun + c.planet);
    const double ring_pitch = c.distance_mm * static_cast<double>(c.ring) / static_cast<double>(c.ring - c.planet);
    for (std::size_t n = 0; n < c.planets; ++n) {
      const Eigen::Vector2d arm = places[n].at - axis, out = arm.normalized();
      BOOST_TEST(arm.norm() == scale * c.distance_mm, boost::test_tools::tolerance(1e-4));
      // The first planet at the top, the others counter-clockwise.
      const double phi = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(c.planets);
      BOOST_TEST((out - Eigen::Vector2d(-std::sin(phi), -std::cos(phi))).norm() < 1e-4);
      const double reach = 6 * c.module_mm * scale;
      const auto outer = test::fit(planets[n], sun.front(), false, axis + scale * pitch * out, reach);
      const auto inner = test::fit(planets[n], ring.front(), true, axis + scale * ring_pitch * out, reach);
      for (const auto& fit : {outer, inner}) {
        BOOST_TEST(fit.overlap < drawn_to);
        BOOST_TEST(fit.gap < drawn_to);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(outside_and_pins_stand_to_scale) {
  const auto pinned =
      test::replaced(test::quick_scene(), "structure = \"traditional\"",
                     "structure = \"pinned\"\npins = 24\npin_diameter_mm = 15.5\nfirst_pin_angle_deg = 3");
  const auto svg = stage_svg(pinned);
  const double scale = scale_of(svg);
  BOOST_TEST(svg.find(">⌀ 663.6<") != std::string::npos);
  BOOST_TEST(svg.find(">a = 201<") != std::string::npos);
  const auto ring = uses(svg, "gear-t-ring").front();
  static const std::regex pin("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\" r=\"([0-9.]+)\" fill=\"#D55E00\"");
  std::size_t pins = 0;
  for (std::sregex_iterator at(svg.begin(), svg.end(), pin), end; at != end; ++at, ++pins) {
    const Eigen::Vector2d place = Eigen::Vector2d(std::stod((*at)[1]), std::stod((*at)[2])) - ring.at;
    BOOST_TEST(place.norm() == scale * 663.6 / 2, boost::test_tools::tolerance(1e-3));
    BOOST_TEST(std::stod((*at)[3]) == scale * 15.5 / 2, boost::test_tools::tolerance(1e-3));
    // From the centre of the ring's tooth 0, which is drawn pointing up when it is not turned.
    const double own = std::atan2(-place.x(), -place.y()) + ring.angle - 3 * units::deg;
    const double pitch = 2 * std::numbers::pi / 24;
    BOOST_TEST(std::abs(std::remainder(own, pitch)) < 1e-3);
  }
  BOOST_TEST(pins == 24U);
  BOOST_TEST(svg.size() < 40000U);
  // Its hearers are told the same.
  const auto label = attribute(svg, "<svg", "aria-label");
  for (const char* word : {"sun of 48", "5 planets of 55", "ring of 162", "24 pins", "663.6 mm", "201 mm"})
    BOOST_TEST(label.find(word) != std::string::npos, word << " in: " << label);
}

BOOST_AUTO_TEST_CASE(enlarged_teeth_show_what_contact_follows_from) {
  const auto scene = app::parse_scene(test::small_stage(), "s");
  const auto geometry = app::make_geometry(scene);
  // Standard gears at the reference centre distance: working pressure angle 20 deg, base diameters m z cos 20 deg.
  const auto svg =
      app::to_svg({.title = "a<b", .id = "t", .pinion_name = "planet", .wheel_name = "sun"}, geometry.sun_mesh());
  BOOST_TEST(svg.find("a&lt;b") != std::string::npos);
  BOOST_TEST(svg.find("working pressure angle 20°") != std::string::npos);
  BOOST_TEST(svg.find("base circles ⌀ 90.2105 (planet), ⌀ 90.2105 (sun)") != std::string::npos);
  BOOST_TEST(svg.find("working pitch circles ⌀ 96 (planet), ⌀ 96 (sun)") != std::string::npos);
  // Path of contact of two gears of 24 teeth with an addendum of a module: 2 (sqrt(r_a^2 - r_b^2) - r sin 20 deg).
  const double path = 2 * (std::sqrt(52 * 52 - 45.105246 * 45.105246) - 48 * std::sin(20 * units::deg));
  BOOST_TEST(svg.find("line of action, " + app::mm_text(path * units::mm) + " mm") != std::string::npos);
  // The end of the path of contact lies on the planet's tip circle, its length is to scale.
  static const std::regex thick(
      "<path d=\"M([-0-9.]+) ([-0-9.]+)L([-0-9.]+) ([-0-9.]+)\" stroke=\"#c22f2f\" stroke-width=\"2.6\"");
  std::smatch match;
  BOOST_TEST_REQUIRE(std::regex_search(svg, match, thick));
  const Eigen::Vector2d a(std::stod(match[1]), std::stod(match[2])), e(std::stod(match[3]), std::stod(match[4]));
  const double scale = scale_of(svg);
  BOOST_TEST((e - a).norm() == scale * path, boost::test_tools::tolerance(1e-3));
  const auto planet = gears(svg, "t-pinion").front(), sun = gears(svg, "t-wheel").front();
  BOOST_TEST((e - uses(svg, "gear-t-pinion").front().at).norm() == scale * 52, boost::test_tools::tolerance(1e-3));
  BOOST_TEST((a - uses(svg, "gear-t-wheel").front().at).norm() == scale * 52, boost::test_tools::tolerance(1e-3));
  // Contact points stand on both outlines.
  static const std::regex dot("<circle cx=\"([-0-9.]+)\" cy=\"([-0-9.]+)\" r=\"4.00\" fill=\"#c22f2f\"");
  std::size_t dots = 0;
  for (std::sregex_iterator at(svg.begin(), svg.end(), dot), end; at != end; ++at, ++dots) {
    const Eigen::Vector2d p(std::stod((*at)[1]), std::stod((*at)[2]));
    BOOST_TEST(test::distance(planet, p) < drawn_to);
    BOOST_TEST(test::distance(sun, p) < drawn_to);
  }
  BOOST_TEST(dots == 1U);  // a contact ratio of 1.6: one pair touches around the pitch point
}

BOOST_AUTO_TEST_CASE(axial_sections_show_every_structure) {
  const auto ring = [&](const app::Scene& scene) {
    const auto geometry = app::make_geometry(scene);
    return app::to_svg({.title = "r",
                        .ring = geometry.rings.front().set.ring(),
                        .outside_radius = geometry.rings.front().outside_radius,
                        .structure = app::ring_structure(planetary(scene).rings.front())});
  };
  const auto svg_of = [&](const std::string& structure) {
    return ring(app::parse_scene(test::replaced(test::quick_scene(), "structure = \"traditional\"", structure), "s"));
  };
  const auto held = svg_of("structure = \"traditional\"");
  BOOST_TEST(held.find(">b = 88<") != std::string::npos);
  BOOST_TEST(held.find("⌀ 663.6 outside") != std::string::npos);
  // Internal tip diameter m (z + 2 (x - 1)) = 3.8 (162 + 2 (0.1516 - 1)).
  BOOST_TEST(held.find("⌀ 609.1522 tip") != std::string::npos);
  const auto sleeve = svg_of(
      "structure = \"thin_walled\"\nfree_length_mm = 18\nsleeve_thickness_mm = 10.6\nhoop_width_mm = 15\n"
      "hoop_thickness_mm = 12");
  for (const char* figure : {">18<", ">10.6<", ">15<", ">12<", "⌀ 687.6 hoop"})
    BOOST_TEST(sleeve.find(figure) != std::string::npos, figure);
  // The sleeve's rectangle is to scale.
  const double scale = scale_of(sleeve);
  static const std::regex rect("<rect x=\"[0-9.]+\" y=\"[0-9.]+\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"");
  bool found = false;
  for (std::sregex_iterator at(sleeve.begin(), sleeve.end(), rect), end; at != end; ++at)
    found = found || (std::abs(std::stod((*at)[1]) - 18 * scale) < drawn_to &&
                      std::abs(std::stod((*at)[2]) - 10.6 * scale) < drawn_to);
  BOOST_TEST(found);
  BOOST_TEST(
      svg_of("structure = \"traditional\"\nflange_width_mm = 20\nflange_diameter_mm = 740").find("⌀ 740 flange") !=
      std::string::npos);
  BOOST_TEST(svg_of("structure = \"bolted\"\npins = 12\npin_diameter_mm = 10").find(">12 bolts ⌀ 10<") !=
             std::string::npos);
  const auto clamped = svg_of(
      "structure = \"clamped\"\nclamp_inner_diameter_mm = 640\nbolts = 36\nbolt_circle_diameter_mm = 652\n"
      "bolt_diameter_mm = 9\ndowels = 6\ndowel_diameter_mm = 8");
  for (const char* figure : {">11.8<", "⌀ 640 clamped from", ">36 bolts ⌀ 9<", ">6 dowels ⌀ 8<"})
    BOOST_TEST(clamped.find(figure) != std::string::npos, figure);
  BOOST_TEST(times(held, "<g") == times(held, "</g>"));
}

BOOST_AUTO_TEST_CASE(dimensions_carry_their_figures) {
  BOOST_TEST(app::mm_text(0.6636) == "663.6");
  BOOST_TEST(app::mm_text(41.2345e-6) == "0.0412");
  // A line from the left to the right, dimensioned above it: the text stands above, arrow heads at both ends.
  const auto svg = app::dimension({100, 200}, {300, 200}, 20, "a<b");
  BOOST_TEST(svg.find("a&lt;b") != std::string::npos);
  BOOST_TEST(svg.find("translate(200.0 176.5) rotate(0.00)") != std::string::npos);
  BOOST_TEST(svg.find("M100.00 180.00L") != std::string::npos);
  BOOST_TEST(svg.find("M300.00 180.00L") != std::string::npos);
  // Too short for its text: that stands behind the end.
  const auto narrow = app::dimension({100, 200}, {110, 200}, 20, "12.345");
  static const std::regex place("translate\\(([0-9.]+) ");
  std::smatch match;
  BOOST_TEST_REQUIRE(std::regex_search(narrow, match, place));
  BOOST_TEST(std::stod(match[1]) > 125);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
