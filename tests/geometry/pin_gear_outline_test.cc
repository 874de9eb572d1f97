#include "geometry/pin_gear_outline.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "polygons.h"

namespace annulus::geometry::test {

namespace {

constexpr PinGear arc_gear{.pins = 30, .eccentricity = 1.5e-3, .pin_circle_radius = 72e-3, .pin_radius = 3e-3};

}  // namespace

BOOST_AUTO_TEST_SUITE(pin_gears)

// Rolling of the gear's pitch circle a (pins - 1) in that of the pins, a pins: a turn of the crank by phi turns the
// gear by -phi / (pins - 1). In every place all pins touch the outline and none enters it.
BOOST_AUTO_TEST_CASE(all_pins_touch_the_outline_in_every_place) {
  const auto outline = pin_gear_outline(arc_gear, 400);
  for (const double phi : {0.0, 0.7, 2.9, 5.1}) {
    annulus::test::Polyline placed;
    const Eigen::Vector2d centre(arc_gear.eccentricity * std::cos(phi), arc_gear.eccentricity * std::sin(phi));
    for (const auto& point : outline) placed.push_back(annulus::test::moved(point, centre, -phi / (arc_gear.pins - 1)));
    for (int k = 0; k < arc_gear.pins; ++k) {
      const double angle = 2 * std::numbers::pi * k / arc_gear.pins;
      const Eigen::Vector2d pin = arc_gear.pin_circle_radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      // Chords of 50 to 92 µm, where they are longest on a curvature of 3.6 mm: a sagitta of 0.29 µm at most.
      BOOST_TEST(std::abs(annulus::test::distance(placed, pin) - arc_gear.pin_radius) < 0.3e-6);
      BOOST_TEST(!annulus::test::inside(placed, pin));
    }
  }
}

BOOST_AUTO_TEST_CASE(teeth_repeat_and_are_as_high_as_twice_the_eccentricity) {
  constexpr int steps = 100;
  const auto outline = pin_gear_outline(arc_gear, steps);
  BOOST_TEST_REQUIRE(outline.size() == 29U * steps);
  double least = 1, most = 0;
  for (const auto& p : outline) {
    least = std::min(least, p.norm());
    most = std::max(most, p.norm());
  }
  const double tip = arc_gear.pin_circle_radius + arc_gear.eccentricity - arc_gear.pin_radius;
  BOOST_TEST(std::abs(most - tip) < 1e-9);
  BOOST_TEST(std::abs(most - least - 2 * arc_gear.eccentricity) < 1e-9);
  for (int i = 0; i < steps; ++i)
    BOOST_TEST(
        (annulus::test::moved(outline[i], Eigen::Vector2d::Zero(), 2 * std::numbers::pi / 29) - outline[i + steps])
            .norm() < 1e-14);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::geometry::test
