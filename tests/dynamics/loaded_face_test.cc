#include "core/loaded_face.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

#include "core/errors.h"
#include "dynamics/spatial/even_face.h"
#include "tests/verification_record.h"

namespace annulus {

namespace {

constexpr double width = 0.1, force = 12e3, stiffness = 2e9;

dynamics::EvenFace even_face(const std::vector<double>& gap) {
  std::vector<double> stations;
  for (std::size_t i = 0; i < gap.size(); ++i)
    stations.push_back(width * (static_cast<double>(i) / static_cast<double>(gap.size() - 1) - 0.5));
  return {stiffness, stations, gap};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(loaded_face)

// A bed of springs under a force beside its middle: a straight line load, and beyond a sixth of the width a triangle
// over three times the distance to the end.
BOOST_AUTO_TEST_CASE(bed_of_springs_beside_its_middle) {
  test::Verification record("Even face under a force beside its middle", "line load of a bed of springs");
  const auto face = even_face({0, 0, 0, 0, 0});
  for (const double place : {0.0, 0.008, -0.016, 0.02, 0.04, -0.047}) {
    const auto found = flanks_under(face, force, place);
    const double from_end = width / 2 - std::abs(place);
    const double most =
        from_end > width / 3 ? force / width * (1 + 6 * std::abs(place) / width) : 2 * force / (3 * from_end);
    record.at_most("largest line load, relative", "", std::abs(found.load.line_load.maxCoeff() / most - 1), 1e-7,
                   "Newton's method");
    BOOST_TEST(std::abs(found.load.force[0] - force) < 2e-6 * force);
    BOOST_TEST(std::abs(found.load.force[1] - force * 2 * place / width) < 2e-6 * force);
  }
  // While all of it carries, the moment over half the width is a third of the stiffness times the tilt.
  const auto whole = flanks_under(face, force, 0.01);
  BOOST_TEST(whole.tilt_stiffness() == stiffness / 3, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(whole.tilt == 3 * force * 0.2 / stiffness, boost::test_tools::tolerance(1e-6));
}

// A wedge of 8 um over the face is a tilt of 4 um.
BOOST_AUTO_TEST_CASE(wedge_is_a_tilt) {
  const auto even = even_face({0, 0, 0}), wedge = even_face({-4e-6, 0, 4e-6});
  const auto a = flanks_under(even, force, 0.01), b = flanks_under(wedge, force, 0.01);
  BOOST_TEST(b.tilt - a.tilt == 4e-6, boost::test_tools::tolerance(1e-5));
  BOOST_TEST((a.load.line_load - b.load.line_load).cwiseAbs().maxCoeff() < 1e-5 * force / width);
}

BOOST_AUTO_TEST_CASE(force_beyond_the_face_is_refused) {
  const auto face = even_face({0, 0, 0});
  BOOST_CHECK_THROW((void)flanks_under(face, force, 0.051), SolverError);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
