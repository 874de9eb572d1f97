#include "dynamics/systems/helical_pair/manufacturing_error.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"
#include "core/units.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(manufacturing_error)

using namespace annulus;
using namespace annulus::dynamics;

/// Table 1 of the paper.
ErrorProblem paper() {
  ErrorProblem problem;
  for (const int g : {0, 1}) problem.gears[g] = {g == 0 ? 21 : 37, 48.927 * units::um, 12.927 * units::um};
  return problem;
}

double normal_probability(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Kolmogorov's distance of draws to a law.
template <class Law>
double kolmogorov(std::vector<double> values, const Law& law) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double distance = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    distance = std::max(distance, std::abs(law(values[i]) - (static_cast<double>(i) + 0.5) / n));
  return distance;
}

BOOST_AUTO_TEST_CASE(readings_of_95_percent_of_the_paper) {
  test::Verification record("Random manufacturing errors: scales and 95 % readings",
                            "printed figures of the paper (docs/helical_pair.md)");
  const auto problem = paper();
  const char* digits = "half of the last printed digit";
  record.near("scale of the pitch error", "um", problem.eta_1(0) / units::um, 5.294, 5e-4, digits);
  record.near("scale of the tooth-to-tooth error", "um", problem.eta_2(0) / units::um, 1.901, 5e-4, digits);
  record.near("divisor", "", exact_divisor(), 6.817, 5e-4, digits);
  const auto result = dynamics::manufacturing_error(problem);
  // Reference values from rounded scales: half a unit of the second decimal and some.
  const auto is = [&](const char* name, double expected) {
    record.near(std::string("95 % of ") + name, "um", result.at(name).exact / units::um, expected, 6e-3,
                "half a unit of the second decimal, rounded scales");
  };
  is("pinion_error", 9.25);
  is("pinion_error_magnitude", 11.03);
  is("pinion_x1", 12.96);
  is("pinion_envelope", 13.25);
  is("sum", 13.08);
  BOOST_TEST(result.amplitude().name == "pinion_envelope");
  BOOST_TEST(result.readings.size() == 14u);
  BOOST_CHECK_THROW((void)result.at("envelope"), InputError);
}

BOOST_AUTO_TEST_CASE(quantiles_lie_in_their_intervals) {
  test::Verification record("Quantiles of 10 000 draws of random errors, fourteen readings",
                            "quantiles of the laws, which the confidence intervals of 0.999 hold");
  auto problem = paper();
  problem.confidence = 0.999;  // all fourteen of one seed
  for (const auto& reading : dynamics::manufacturing_error(problem).readings) {
    const char* origin = "confidence of 0.999";
    record.at_most("lower end of the interval over the quantile", "", reading.sample.low / reading.exact, 1, origin);
    record.at_least("upper end of the interval over the quantile", "", reading.sample.high / reading.exact, 1, origin);
    const double width = reading.sample.high - reading.sample.low;
    record.at_most("width of the interval over the quantile", "", width / reading.exact, 0.1, "ceiling beside it");
    BOOST_TEST(width < 0.1 * reading.exact, reading.name);
  }
}

BOOST_AUTO_TEST_CASE(intervals_cover_as_often_as_they_say) {
  test::Verification record("Confidence intervals of quantiles of random errors", "their level, 0.95, over 300 seeds");
  auto problem = paper();
  problem.samples = 1000;
  constexpr int runs = 300;
  int covered = 0;
  for (problem.seed = 1; problem.seed <= runs; ++problem.seed) {
    const auto r = dynamics::manufacturing_error(problem).amplitude();
    covered += r.sample.low <= r.exact && r.exact <= r.sample.high;
  }
  // Four standard deviations below 0.95; the interval is conservative, so nothing above.
  record.at_least("share of intervals that hold the exact quantile", "", static_cast<double>(covered) / runs,
                  0.95 - 4 * std::sqrt(0.95 * 0.05 / runs), "four standard deviations; they are conservative");
}

BOOST_AUTO_TEST_CASE(draws_follow_their_laws) {
  test::Verification record("Draws of random errors follow their laws",
                            "Kolmogorov's distance to the laws; exceeded with probability 0.001");
  const auto problem = paper();
  for (const int g : {0, 1}) {
    const auto d = draw_errors(problem, g);
    const double a = problem.eta_1(g), b = problem.eta_2(g), deviation = std::hypot(a, b);
    std::vector<double> envelope, crest;
    for (std::size_t i = 0; i < d.x_1.size(); ++i) {
      envelope.push_back(std::hypot(d.x_1[i], d.x_2[i]));
      crest.push_back(d.x_1[i] + d.x_2[i]);
    }
    // Exceeded with probability 0.001. That T is normal to 2e-4 only does not show at 10 000 draws.
    const double bound = 1.95 / std::sqrt(problem.samples);
    const char* origin = "1.95 / sqrt(number of draws)";
    record.at_most("error", "", kolmogorov(d.error, [&](double x) { return normal_probability(x / deviation); }), bound,
                   origin);
    record.at_most("first amplitude", "", kolmogorov(d.x_1, [&](double x) { return rayleigh_probability(x, a); }),
                   bound, origin);
    record.at_most("envelope", "", kolmogorov(envelope, [&](double x) { return envelope_probability(x, a, b); }), bound,
                   origin);
    record.at_most("crest", "", kolmogorov(crest, [&](double x) { return crest_probability(x, a, b); }), bound, origin);
    // The test is sharp: a law ten per cent wider is refused.
    BOOST_TEST(kolmogorov(d.error, [&](double x) { return normal_probability(x / (1.1 * deviation)); }) > bound);
  }
}

BOOST_AUTO_TEST_CASE(laws_agree_with_quadrature_and_limits) {
  test::Verification record("Laws of the envelope and of the crest of two random amplitudes",
                            "midpoint rule over 400 000 probabilities; law of Erlang for equal amplitudes");
  for (const auto& [a, b] : {std::pair{5.294, 1.901}, {1.0, 3.0}, {2.0, 2.0}})
    for (const double r : {1.0, 4.0, 9.0}) {
      // Over the probabilities u of X_1 in the midpoint rule; smooth but for its ends.
      constexpr int n = 400000;
      double envelope = 0, crest = 0;
      for (int i = 0; i < n; ++i) {
        const double x = a * std::sqrt(-2 * std::log((i + 0.5) / n));
        if (x >= r) continue;
        envelope += rayleigh_probability(std::sqrt(r * r - x * x), b) / n;
        crest += rayleigh_probability(r - x, b) / n;
      }
      record.close("probability of the envelope", "", envelope_probability(r, a, b), envelope, 5e-6,
                   "the rule at the narrowest r");
      record.close("probability of the crest", "", crest_probability(r, a, b), crest, 5e-6,
                   "the rule at the narrowest r");
      BOOST_TEST(envelope_probability(r, a, b) == envelope_probability(r, b, a));
    }
  // Alike amplitudes: the law of Erlang; nearly alike ones join it smoothly.
  const double s = 1.7 * 1.7 / 2, erlang = 1 - std::exp(-s) * (1 + s);
  record.close("probability of the envelope, equal amplitudes", "", envelope_probability(1.7, 1, 1), erlang, 1e-14,
               "rounding");
  for (const double off : {1e-12, 1e-9, 1e-7, 1e-5})
    BOOST_TEST(std::abs(envelope_probability(1.7, 1, 1 + off) - erlang) < 2 * off + 1e-15);
}

BOOST_AUTO_TEST_CASE(draws_do_not_depend_on_their_number) {
  auto problem = paper();
  const auto many = draw_errors(problem, 1);
  problem.samples = 100;
  const auto few = draw_errors(problem, 1);
  int different = 0;
  for (std::size_t i = 0; i < few.error.size(); ++i) different += few.error[i] != many.error[i];
  test::Verification record("The first 100 of 10 000 draws", "100 draws of the same seed");
  record.at_most("draws that differ", "", different, 0, "equal to the last bit");
  problem.seed = 2;
  BOOST_TEST(draw_errors(problem, 1).error != few.error);
}

BOOST_AUTO_TEST_CASE(histogram_counts_every_draw) {
  test::Verification record("Histogram of random errors", "chi-squared test against the law, 0.999");
  const auto problem = paper();
  const auto h = dynamics::manufacturing_error(problem).histogram;
  int total = 0, bins = 0;
  double statistic = 0;
  for (std::size_t i = 0; i < h.count.size(); ++i) {
    total += h.count[i];
    if (h.expected[i] < 5) continue;
    statistic += std::pow(h.count[i] - h.expected[i], 2) / h.expected[i];
    ++bins;
  }
  BOOST_TEST(total == problem.samples);
  BOOST_TEST(bins > 30);
  record.at_most("chi-squared statistic", "", statistic, quantile(boost::math::chi_squared(bins), 0.999),
                 "exceeded with probability 0.001");
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused) {
  const auto refused = [](auto change) {
    auto problem = paper();
    change(problem);
    BOOST_CHECK_THROW((void)dynamics::manufacturing_error(problem), InputError);
  };
  refused([](ErrorProblem& p) { p.samples = 0; });
  refused([](ErrorProblem& p) { p.gears[1].tooth_to_tooth = 50e-6; });
  refused([](ErrorProblem& p) { p.gears[0].tooth_to_tooth = 0; });
  refused([](ErrorProblem& p) { p.gears[0].teeth = 0; });
  refused([](ErrorProblem& p) { p.probability = 1; });
  refused([](ErrorProblem& p) { p.divisor = 0; });
  refused([](ErrorProblem& p) { p.bins = 0; });
}

BOOST_AUTO_TEST_SUITE_END()
