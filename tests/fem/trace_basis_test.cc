#include "fem/elasticity/trace_basis.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "core/errors.h"

BOOST_AUTO_TEST_SUITE(trace)

using annulus::fem::TraceBasis;

/// Graded elements on [0.2, 1.4] whose inner nodes stand at the Gauss-Lobatto points; `bend` moves them off: the
/// coordinate is then a curved function of the reference coordinate, as a roll length is.
std::vector<double> stations(int degree, int elements, double bend) {
  const std::vector<std::vector<double>> lobatto = {
      {0, 1},
      {0, 0.5, 1},
      {0, (1 - std::sqrt(0.2)) / 2, (1 + std::sqrt(0.2)) / 2, 1},
      {0, (1 - std::sqrt(3.0 / 7)) / 2, 0.5, (1 + std::sqrt(3.0 / 7)) / 2, 1}};
  std::vector<double> result = {0.2};
  double total = 0;
  for (int e = 0; e < elements; ++e) total += std::pow(1.5, e);
  for (int e = 0; e < elements; ++e) {
    const double low = result.back(), length = 1.2 * std::pow(1.5, e) / total;
    for (int i = 1; i <= degree; ++i) {
      const double xi = lobatto[degree - 1][i];
      result.push_back(low + length * (xi + bend * xi * (1 - xi)));
    }
  }
  return result;
}

double interpolate(const TraceBasis& basis, const std::function<double(double)>& f, double x) {
  const auto values = basis(x);
  double sum = 0;
  for (std::size_t i = 0; i < values.weights.size(); ++i)
    sum += values.weights[i] * f(basis.stations()[values.first + static_cast<int>(i)]);
  return sum;
}

constexpr double round_off = 1e-13;  // some tens of operations on numbers of order one, Newton to 1e-14

BOOST_AUTO_TEST_CASE(shape_functions_sum_to_one_and_are_one_at_their_node) {
  for (const int degree : {1, 2, 3, 4})
    for (const double bend : {0.0, 0.2}) {
      const TraceBasis basis(stations(degree, 5, degree > 1 ? bend : 0), degree);
      BOOST_TEST(basis.elements() == 5);
      BOOST_TEST(basis.size() == 5 * degree + 1);
      for (int k = 0; k <= 100; ++k) {
        const auto values = basis(0.2 + 1.2 * k / 100);
        BOOST_TEST(static_cast<int>(values.weights.size()) == degree + 1);
        BOOST_TEST(values.first % degree == 0);
        BOOST_TEST(std::accumulate(values.weights.begin(), values.weights.end(), 0.0) == 1.0,
                   boost::test_tools::tolerance(round_off));
      }
      for (int n = 0; n < basis.size(); ++n) {
        const auto values = basis(basis.stations()[n]);
        for (std::size_t i = 0; i < values.weights.size(); ++i)
          BOOST_TEST(std::abs(values.weights[i] - (values.first + static_cast<int>(i) == n ? 1.0 : 0.0)) < round_off);
      }
    }
}

BOOST_AUTO_TEST_CASE(polynomials_up_to_the_degree_are_reproduced) {
  for (const int degree : {1, 2, 3, 4}) {
    const TraceBasis basis(stations(degree, 4, 0), degree);
    for (int power = 0; power <= degree; ++power)
      for (int k = 0; k <= 50; ++k) {
        const double x = 0.2 + 1.2 * k / 50;
        BOOST_TEST(interpolate(
                       basis, [&](double u) { return std::pow(u, power); }, x) == std::pow(x, power),
                   boost::test_tools::tolerance(round_off));
      }
    // One power more is not: the test can fail.
    const double x = 0.27;
    BOOST_TEST(std::abs(interpolate(
                            basis, [&](double u) { return std::pow(u, degree + 1); }, x) -
                        std::pow(x, degree + 1)) > 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(a_curved_coordinate_is_inverted) {
  // Isoparametric: whatever the nodes' spacing, the coordinate itself is reproduced.
  const TraceBasis basis(stations(2, 3, 0.3), 2);
  for (int k = 0; k <= 50; ++k) {
    const double x = 0.2 + 1.2 * k / 50;
    BOOST_TEST(interpolate(
                   basis, [](double u) { return u; }, x) == x,
               boost::test_tools::tolerance(round_off));
  }
}

BOOST_AUTO_TEST_CASE(means_integrate_the_interpolant) {
  const int degree = 3;
  const TraceBasis basis(stations(degree, 4, 0), degree);
  const auto mean = [&](double low, double high, int power) {
    const auto weights = basis.mean_over(low, high);
    double sum = 0;
    for (int n = 0; n < basis.size(); ++n) sum += weights[n] * std::pow(basis.stations()[n], power);
    return sum;
  };
  const std::vector<std::pair<double, double>> intervals = {{0.2, 1.4}, {0.3, 0.31}, {0.25, 1.1}, {1.39, 1.4}};
  for (const auto& [low, high] : intervals)
    for (int power = 0; power <= degree; ++power) {
      const double exact = (std::pow(high, power + 1) - std::pow(low, power + 1)) / ((power + 1) * (high - low));
      // Cancellation of the closed form for short intervals: 1 / (high - low) more.
      BOOST_TEST(mean(low, high, power) == exact, boost::test_tools::tolerance(round_off / (high - low)));
    }
}

BOOST_AUTO_TEST_CASE(what_lies_outside_is_refused) {
  const TraceBasis basis(stations(2, 3, 0), 2);
  BOOST_CHECK_THROW((void)basis(0.2 - 1e-6), annulus::InternalError);
  BOOST_CHECK_THROW((void)basis(1.4 + 1e-6), annulus::InternalError);
  BOOST_CHECK_NO_THROW((void)basis(1.4 + 1e-10));  // round-off of its own coordinate is not outside
  BOOST_CHECK_THROW(TraceBasis({0, 1, 2, 3}, 2), annulus::InternalError);
  BOOST_CHECK_THROW(TraceBasis({0, 1, 2, 3, 4, 5}, 5), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
