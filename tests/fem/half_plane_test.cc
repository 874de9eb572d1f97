#include "fem/contact/half_plane.h"

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(half_plane)

using annulus::fem::HalfPlane;
using annulus::fem::Material;

const Material steel{};
const HalfPlane plane(steel);
/// u = factor * integral of p ln|x - s| (Johnson, Contact Mechanics, 2.3).
const double factor = -2 * (1 - steel.poisson_ratio * steel.poisson_ratio) / (M_PI * steel.youngs_modulus);

/// Density of a unit load of half-length 1.
using Shape = std::function<double(double)>;
double strip(double) { return 0.5; }
double semi_ellipse(double s) { return 2 / M_PI * std::sqrt(std::max(0.0, (1 - s) * (1 + s))); }

double integrate(const std::function<double(double)>& f, double low, double high) {
  static boost::math::quadrature::tanh_sinh<double> rule(8);
  return high > low ? rule.integrate(f, low, high, 1e-11) : 0;
}

/// Integral of p(s) ln|x - s| for a load of half-length h about 0: over the distance t = |x - s|, whose logarithm
/// tanh-sinh integrates from 0.
double potential(const Shape& p, double h, double x) {
  const auto side = [&](double sense) {  // s = x + sense t, within [-h, h]
    const double a = sense * (-h - x), b = sense * (h - x);
    return integrate([&](double t) { return std::log(t) * p((x + sense * t) / h) / h; }, std::max(0.0, std::min(a, b)),
                     std::max(0.0, std::max(a, b)));
  };
  return side(1) + side(-1);
}

/// Mean of the potential of one load, weighted with another, `distance` apart: by adaptive quadrature, cut where the
/// ends of the load stand.
double mean_potential(const Shape& p, double distance, double half_a, double half_b) {
  std::vector<double> cuts = {-half_a, half_a};
  for (const double end : {-half_b, half_b})
    if (std::abs(end - distance) < half_a) cuts.push_back(end - distance);
  std::sort(cuts.begin(), cuts.end());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    sum += integrate([&](double t) { return potential(p, half_b, distance + t) * p(t / half_a) / half_a; }, cuts[i],
                     cuts[i + 1]);
  return sum;
}

struct Case {
  const char* name;
  double distance, half_a, half_b;
};
/// Half-lengths as unequal as the elements of one window and the loads near a tip edge: 1 to 30.
const std::vector<Case> cases = {{"identical", 0, 1, 1},
                                 {"within", 0.3, 0.2, 1},
                                 {"overlapping", 0.7, 0.5, 1},
                                 {"touching", 2, 1, 1},
                                 {"touching unequal", 1.1, 0.1, 1},
                                 {"near", 2.5, 1, 1},
                                 {"near, one short", 1.2, 1, 0.05},
                                 {"concentric unequal", 0, 1.0 / 30, 1},
                                 {"far", 40, 1, 0.3},
                                 {"very far", 500, 1, 0.2}};

BOOST_AUTO_TEST_CASE(strips_equal_the_integral) {
  annulus::test::Verification record("Half-plane under a strip of constant pressure, mean over another strip",
                                     "adaptive quadrature of Flamant's solution (Johnson, Contact Mechanics, 2.3)");
  for (const auto& c : cases) {
    const double exact = mean_potential(strip, c.distance, c.half_a, c.half_b);
    const double error = plane.strips(c.distance, c.half_a, c.half_b) / factor - exact;
    BOOST_TEST_MESSAGE(c.name << ": " << exact << ", error " << error);
    const double computed = exact + error;
    // The quadrature stops at 1e-11; the closed form loses a factor of distance^2 / (half_a half_b), at most 5e3 where
    // it is used here, to cancellation; the series for the far field leaves out (half / distance)^4 = 2e-11.
    record.near(std::string("mean of ln r, ") + c.name, "", computed, exact, 2e-10,
                "quadrature 1e-11, cancellation, series of the far field 2e-11");
  }
}

BOOST_AUTO_TEST_CASE(semi_ellipses_equal_the_integral) {
  annulus::test::Verification record("Half-plane under a semi-elliptical pressure, mean over another",
                                     "adaptive quadrature of Flamant's solution (Johnson, Contact Mechanics, 2.3)");
  for (const auto& c : cases) {
    const double exact = mean_potential(semi_ellipse, c.distance, c.half_a, c.half_b);
    const double error = plane.semi_ellipses(c.distance, c.half_a, c.half_b) / factor - exact;
    BOOST_TEST_MESSAGE(c.name << ": " << exact << ", error " << error);
    const double low = std::abs(c.distance) - std::min(c.half_a, c.half_b);
    const double high = std::abs(c.distance) + std::min(c.half_a, c.half_b), wide = std::max(c.half_a, c.half_b);
    // Twelve Gauss points are exact in the quadratic potential beneath the wider load and nearly so far from it; they
    // see its root-like end, (x - 1)^(3/2), with some 13^-4.
    const bool across_the_end = low < wide && high > wide, at_the_end = low < 1.5 * wide && high > wide;
    record.near(std::string("mean of ln r, ") + c.name, "", exact + error, exact,
                across_the_end || at_the_end ? 1e-4 : 2e-10,
                across_the_end || at_the_end ? "twelve Gauss points over the root-like end" : "quadrature");
  }
}

BOOST_AUTO_TEST_CASE(load_and_mean_may_change_places) {
  for (const auto& c : cases) {
    const double d = c.distance, a = c.half_a, b = c.half_b;
    // Reciprocity (Betti) and mirror images; round-off of the sums above.
    BOOST_TEST(std::abs(plane.strips(d, a, b) - plane.strips(d, b, a)) < 1e-11 * std::abs(factor));
    BOOST_TEST(std::abs(plane.strips(d, a, b) - plane.strips(-d, a, b)) < 1e-11 * std::abs(factor));
    BOOST_TEST(std::abs(plane.semi_ellipses(d, a, b) - plane.semi_ellipses(d, b, a)) < 1e-13 * std::abs(factor));
    BOOST_TEST(std::abs(plane.semi_ellipses(d, a, b) - plane.semi_ellipses(-d, a, b)) < 1e-13 * std::abs(factor));
  }
}

BOOST_AUTO_TEST_CASE(the_difference_of_two_loads_of_one_resultant_dies_with_the_square_of_the_distance) {
  const double element = 0.1, spread = 1;
  // Mean of ln|d + x - s| = ln d - (variance of x + variance of s) / (2 d^2) + O(d^-4); a strip has the variance h^2 /
  // 3, a semi-ellipse h^2 / 4.
  const double coefficient = spread * spread / 4 - element * element / 3;
  double before = 0;
  for (const double d : {5.0, 10.0, 20.0, 40.0}) {
    const double difference =
        (plane.strips(d, element, element) - plane.semi_ellipses(d, spread, spread)) / factor * d * d;
    BOOST_TEST_MESSAGE("distance " << d << ": difference x distance^2 = " << difference << ", limit " << coefficient);
    // The next term is of the relative size (spread / d)^2: 5/4 of it for the fourth moments of two semi-ellipses.
    BOOST_TEST(std::abs(difference / coefficient - 1) < 2 * spread * spread / (d * d));
    if (before != 0) {
      BOOST_TEST(std::abs(difference - coefficient) < 0.3 * std::abs(before - coefficient));
    }
    before = difference;
  }
  // Equal second moments (a semi-ellipse 2 / sqrt(3) as long): the square of the distance goes as well.
  const double own = 2 / std::sqrt(3.0) * element;
  for (const double d : {1.0, 2.0, 4.0})
    BOOST_TEST(std::abs((plane.strips(d, element, element) - plane.semi_ellipses(d, own, own)) / factor) <
               std::pow(element / d, 4));
}

BOOST_AUTO_TEST_SUITE_END()
