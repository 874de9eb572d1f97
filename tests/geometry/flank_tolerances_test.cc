#include "geometry/flank_tolerances.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"

using namespace annulus;
using namespace annulus::geometry;

BOOST_AUTO_TEST_SUITE(flank_tolerances)

/// By hand from [ISO1328-1]: d = 100 mm, m_n = 4 mm: 0.2 + 5.5 + 2.8 + 12 = 20.5 µm in class 5.
BOOST_AUTO_TEST_CASE(values_by_hand) {
  const ToleranceGear gear{.teeth = 25, .module = 4e-3, .reference_diameter = 100e-3};
  BOOST_TEST(cumulative_pitch_tolerance(gear, 7) == 41e-6, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(cumulative_pitch_tolerance(gear, 5) == 21e-6, boost::test_tools::tolerance(1e-12));  // 20.5 to whole ones
  // 0.1 + 1.6 + 5 = 6.7 µm in class 5.
  BOOST_TEST(single_pitch_tolerance(gear, 5) == 6.5e-6, boost::test_tools::tolerance(1e-12));  // to halves
  BOOST_TEST(single_pitch_tolerance(gear, 7) == 13e-6, boost::test_tools::tolerance(1e-12));   // 13.4
  BOOST_TEST(single_pitch_tolerance(gear, 1) == 1.7e-6, boost::test_tools::tolerance(1e-12));  // 1.675
  BOOST_TEST(runout_tolerance(gear, 7) == 37e-6, boost::test_tools::tolerance(1e-12));         // 36.9
  BOOST_TEST(runout_tolerance(gear, 3) == 9e-6, boost::test_tools::tolerance(1e-12));          // 9.225 to halves
  BOOST_TEST(runout_tolerance(gear, 1) == 4.6e-6, boost::test_tools::tolerance(1e-12));        // 4.6125 to tenths
}

/// The edition of 1995 had other formulas for the same classes: F_r = 0.24 m_n + sqrt(d) + 5.6 µm at class 5. The
/// revision kept the level of the classes within 20 % for gears above 100 mm; small gears got wider tolerances.
BOOST_AUTO_TEST_CASE(near_the_earlier_edition) {
  for (const double module : {3.0, 6.0, 12.0})
    for (const int teeth : {40, 70, 120}) {
      const double d = module * teeth;
      const double before = 0.24 * module + std::sqrt(d) + 5.6;
      const double now = runout_tolerance({teeth, module * 1e-3, d * 1e-3}, 5) * 1e6;
      BOOST_TEST(std::abs(now / before - 1) < 0.2, module << " mm, " << teeth << " teeth: " << now << ", " << before);
    }
}

BOOST_AUTO_TEST_CASE(outside_of_the_standard) {
  const ToleranceGear gear{.teeth = 25, .module = 4e-3, .reference_diameter = 100e-3};
  BOOST_CHECK_THROW((void)runout_tolerance(gear, 0), GeometryError);
  BOOST_CHECK_THROW((void)runout_tolerance(gear, 12), GeometryError);
  BOOST_CHECK_THROW((void)runout_tolerance({4, 4e-3, 16e-3}, 6), GeometryError);
  BOOST_CHECK_THROW((void)runout_tolerance({25, 0.4e-3, 10e-3}, 6), GeometryError);
}

BOOST_AUTO_TEST_SUITE_END()
