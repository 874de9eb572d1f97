#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "geometry/iso6336.h"

BOOST_AUTO_TEST_SUITE(iso6336_rim)

using namespace annulus::geometry;

// ISO 6336-3: both branches meet at 1.2 tooth heights (3.5 modules of an internal gear) within the rounding of the
// printed constants.
BOOST_AUTO_TEST_CASE(rim_factors_start_at_one_and_grow_as_the_rim_thins) {
  const auto gear = [](GearKind kind, int teeth) {
    return Gear({.kind = kind,
                 .teeth = teeth,
                 .module = 2e-3,
                 .pressure_angle = std::numbers::pi / 9,
                 .face_width = 0.02,
                 .root_fillet_factor = 0.3});
  };
  const Gear external = gear(GearKind::external, 30), internal = gear(GearKind::internal, 90);
  const double height = external.tip_radius() - external.root_radius();
  BOOST_TEST(rim_thickness_factor(external, 1.3 * height) == 1);
  BOOST_TEST(rim_thickness_factor(external, 1.1999 * height) == 1, boost::test_tools::tolerance(2e-3));
  BOOST_TEST(rim_thickness_factor(external, 0.8 * height) == 1.6 * std::log(2.242 / 0.8),
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(rim_thickness_factor(internal, 8e-3) == 1);
  BOOST_TEST(rim_thickness_factor(internal, 6.9999e-3) == 1, boost::test_tools::tolerance(4e-3));
  BOOST_TEST(rim_thickness_factor(internal, 4e-3) == 1.15 * std::log(8.324 / 2), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(rim_thickness_factor(internal, 1e-3) == rim_thickness_factor(internal, 3.5e-3));
}

BOOST_AUTO_TEST_SUITE_END()
