#include "fem/problem/support_sites.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"
#include "fem/problem/structures/pin_held.h"
#include "fem/problem/structures/spline_held.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(support_sites)

using namespace annulus::fem;

const SupportedRing ring{60, 0.1, 0.03, {}};

BOOST_AUTO_TEST_CASE(a_slender_span_bends_and_a_short_one_shears) {
  annulus::test::Verification record(
      "Stiffness of the free span of a pin",
      "Timoshenko's beam: 12 E I / L^3 when slender, kappa G A / L when short, both ends");
  const Material steel;
  const double d = 0.016, E = steel.youngs_modulus, nu = steel.poisson_ratio;
  const double bending = 2 * 12 * E * M_PI * std::pow(d, 4) / 64;  // x 1 / L^3, both ends
  // Timoshenko's relative share of shear is 12 E I / (kappa G A L^2), about 2 (d / L)^2.
  record.close("slender, L = 100 d", "N/m", pin_span_stiffness(steel, d, 100 * d), bending / std::pow(100 * d, 3), 3e-4,
               "share of shear: 2 (d / L)^2");
  const double shear = 2 * 0.886364 * E / (2 * (1 + nu)) * M_PI * d * d / 4;  // kappa = 7.8 / 8.8 for nu = 0.3
  record.close("short, L = d / 100", "N/m", pin_span_stiffness(steel, d, d / 100), shear / (d / 100), 1e-4,
               "share of bending");
  BOOST_TEST(std::isinf(pin_span_stiffness(steel, d, 0)));
}

BOOST_AUTO_TEST_CASE(pins_are_elastic_in_series_and_as_given) {
  PinHeld pins;
  pins.angles = equal_angles(3, 0.1);
  pins.pin_diameter = 0.01;
  pins.free_span = 0.004;
  const auto derived = pins.supports(ring);
  BOOST_TEST(derived.pins == 3);
  const auto& radial = derived.sites[1].directions[0];
  const double local = derived_pin_stiffness(ring.material, ring.face_width);
  const double span = pin_span_stiffness(ring.material, 0.01, 0.004);
  BOOST_TEST(radial.total_stiffness() == 1 / (1 / local + 1 / span), boost::test_tools::tolerance(1e-14));
  BOOST_TEST(derived.sites[1].directions[1].total_stiffness() == radial.total_stiffness());
  BOOST_TEST(radial.unilateral);
  BOOST_TEST(!derived.sites[1].directions[1].unilateral);
  pins.radial_stiffness = 3e9;
  BOOST_TEST(pins.supports(ring).sites[0].directions[1].stiffness == 3e9);
  BOOST_TEST(std::isinf(pins.supports(ring).sites[0].directions[1].end_stiffness));
  pins.tangential_stiffness = 2e9;
  BOOST_TEST(pins.supports(ring).sites[0].directions[0].stiffness == 3e9);
  BOOST_TEST(pins.supports(ring).sites[0].directions[1].stiffness == 2e9);
}

BOOST_AUTO_TEST_CASE(a_single_pin_needs_a_housing) {
  PinHeld pins;
  pins.angles = {0.3};
  pins.pin_diameter = 0.01;
  BOOST_CHECK_THROW((void)pins.supports(ring), annulus::InputError);
  pins.unilateral = false;
  BOOST_CHECK_THROW((void)pins.supports(ring), annulus::InputError);
  pins.housing_clearance = 10e-6;
  const auto sites = pins.supports(ring);
  BOOST_TEST(sites.sites.size() == 61U);
  BOOST_TEST(sites.pins == 1);
  for (int i = 1; i < 61; ++i) BOOST_TEST(sites.sites[i].directions.at(0).clearance == 10e-6);
  pins.angles.clear();
  BOOST_CHECK_THROW((void)pins.supports(ring), annulus::InputError);
}

BOOST_AUTO_TEST_CASE(spline_flanks_press_along_their_normals) {
  SplineHeld spline;
  spline.teeth = 20;
  spline.flank_angle = 0.5;
  const auto sites = spline.supports(ring);
  BOOST_TEST(sites.pins == 20);
  for (const auto& site : sites.sites) {
    BOOST_TEST_REQUIRE(site.directions.size() == 2U);
    for (const auto& d : site.directions) {
      BOOST_TEST(d.unilateral);
      BOOST_TEST(d.inward == std::sin(0.5));
      BOOST_TEST(std::abs(d.counter_clockwise) == std::cos(0.5));
      BOOST_TEST(d.total_stiffness() == 14e9 * 0.03, boost::test_tools::tolerance(1e-14));
    }
    BOOST_TEST(site.directions[0].counter_clockwise == -site.directions[1].counter_clockwise);
  }
  spline.teeth = 2;
  BOOST_CHECK_THROW((void)spline.supports(ring), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
