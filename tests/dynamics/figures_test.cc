#include "dynamics/figures.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/errors.h"

BOOST_AUTO_TEST_SUITE(figures)

using namespace annulus::dynamics;

BOOST_AUTO_TEST_CASE(load_sharing_of_given_forces) {
  Eigen::MatrixXd force(2, 4);
  force << 1, 3, 1, 3,  //
      3, 1, 3, 1;
  BOOST_TEST(load_sharing_instantaneous(force) == 1.5);  // 2 x 3/4
  BOOST_TEST(load_sharing_averaged(force, 2) == 1.0);    // equal over a cycle of two samples
  BOOST_TEST(load_sharing_averaged(force, 1) == 1.5);
  BOOST_TEST(load_sharing_over_time(force)(1, 2) == 1.5);
  force(0, 3) = 7;  // last cycle: 8 and 4
  BOOST_TEST(std::abs(load_sharing_averaged(force, 2) - 4.0 / 3) <= 1e-15);
  BOOST_TEST(load_sharing_instantaneous(force) == 1.75);
  force.col(1).setZero();
  BOOST_TEST(load_sharing_instantaneous(force) == std::numeric_limits<double>::infinity());
  BOOST_CHECK_THROW((void)load_sharing_averaged(force, 5), annulus::InternalError);
}

BOOST_AUTO_TEST_CASE(spectrum_finds_orders_and_amplitudes) {
  const int cycles = 11, samples = 11 * 32;
  Eigen::VectorXd series(samples);
  for (int i = 0; i < samples; ++i) {
    const double x = static_cast<double>(i) / 32;  // mesh cycles
    series[i] = 5 + 2 * std::cos(2 * std::numbers::pi * x + 0.4) +
                0.5 * std::sin(2 * std::numbers::pi * (3.0 / 11) * x) + std::cos(std::numbers::pi * i);
  }
  const auto found = spectrum(series, cycles);
  BOOST_REQUIRE(found.order.size() == samples / 2 + 1);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(found.order.size());
  expected[0] = 5;
  expected[11] = 2;
  expected[3] = 0.5;
  expected[samples / 2] = 1;
  BOOST_TEST((found.amplitude - expected).cwiseAbs().maxCoeff() <= 1e-13);  // rounding of the transform
  BOOST_TEST(found.order[11] == 1.0);
  BOOST_TEST(found.order[samples / 2] == 16.0);
  BOOST_CHECK_THROW((void)spectrum(series, 0), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
