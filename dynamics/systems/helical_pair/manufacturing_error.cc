#include "dynamics/systems/helical_pair/manufacturing_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/errors.h"
#include "dynamics/statistics/sampling.h"

namespace annulus::dynamics {

namespace {

constexpr const char* gear_names[] = {"pinion", "wheel"};

/// Quantile of a law on r > 0 whose spread is about `scale`.
template <class Probability>
double quantile_of(const Probability& probability, double wanted, double scale) {
  double high = scale;
  while (probability(high) < wanted) high *= 2;
  std::uintmax_t iterations = 100;
  const auto [a, b] = boost::math::tools::toms748_solve([&](double r) { return probability(r) - wanted; }, 0.0, high,
                                                        -wanted, probability(high) - wanted,
                                                        boost::math::tools::eps_tolerance<double>(45), iterations);
  return (a + b) / 2;
}

std::vector<double> magnitudes(std::vector<double> values) {
  for (auto& v : values) v = std::abs(v);
  return values;
}

template <class Join>
std::vector<double> joined(const std::vector<double>& a, const std::vector<double>& b, const Join& join) {
  std::vector<double> result(a.size());
  std::transform(a.begin(), a.end(), b.begin(), result.begin(), join);
  return result;
}

ErrorHistogram histogram_of(const std::vector<double>& values, int bins, double eta_1, double eta_2) {
  ErrorHistogram h;
  h.width = *std::max_element(values.begin(), values.end()) / bins;
  h.count.assign(bins, 0);
  for (const double v : values) ++h.count[std::min(static_cast<int>(v / h.width), bins - 1)];
  double below = 0;
  for (int i = 1; i <= bins; ++i) {
    const double next = envelope_probability(i * h.width, eta_1, eta_2);
    h.expected.push_back(static_cast<double>(values.size()) * (next - below));
    below = next;
  }
  return h;
}

}  // namespace

double exact_divisor() { return 2 * std::sqrt(-2 * std::log(0.003)); }

void ErrorProblem::check() const {
  for (int g = 0; g < 2; ++g) {
    const auto& gear = gears[g];
    if (gear.teeth < 1) throw InputError(fmt::format("{} teeth = {} must be positive", gear_names[g], gear.teeth));
    if (!(gear.tooth_to_tooth > 0) || !std::isfinite(gear.total) || !(gear.total > gear.tooth_to_tooth))
      throw InputError(
          fmt::format("{}: the tooth-to-tooth deviation {} m must be positive and below the total one, {} m",
                      gear_names[g], gear.tooth_to_tooth, gear.total));
  }
  if (!std::isfinite(divisor) || !(divisor > 0))
    throw InputError(fmt::format("the divisor {} of the deviations must be positive", divisor));
  if (samples < 1) throw InputError(fmt::format("a Monte Carlo simulation needs at least one sample, not {}", samples));
  if (bins < 1) throw InputError(fmt::format("a histogram needs at least one bin, not {}", bins));
  for (const double p : {probability, confidence})
    if (!(p > 0 && p < 1)) throw InputError(fmt::format("probability {} must lie between 0 and 1", p));
}

ErrorSamples draw_errors(const ErrorProblem& problem, int gear) {
  problem.check();
  const std::string name = gear_names[gear];
  const CounterDraws x_1(problem.seed, name + "_x1"), x_2(problem.seed, name + "_x2"),
      angle(problem.seed, name + "_angle");
  const double eta_1 = problem.eta_1(gear), eta_2 = problem.eta_2(gear), teeth = problem.gears[gear].teeth;
  const auto n = static_cast<std::size_t>(problem.samples);
  ErrorSamples s{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    s.x_1[i] = eta_1 * std::sqrt(-2 * std::log(x_1(i)));  // [LiuZhangZhangWangWang2020, eq. (4)]
    s.x_2[i] = eta_2 * std::sqrt(-2 * std::log(x_2(i)));
    s.angle[i] = 2 * std::numbers::pi * angle(i);  // [LiuZhangZhangWangWang2020, eq. (9)]
    s.error[i] = s.x_1[i] * std::sin(s.angle[i]) + s.x_2[i] * std::sin(teeth * s.angle[i]);
  }
  return s;
}

double rayleigh_probability(double r, double eta) { return r > 0 ? -std::expm1(-r * r / (2 * eta * eta)) : 0; }

double envelope_probability(double r, double eta_1, double eta_2) {
  if (!(r > 0)) return 0;
  const double s = r * r / 2;
  double a = eta_1 * eta_1, b = eta_2 * eta_2;
  if (a < b) std::swap(a, b);
  // 1 - P = (a e^(-s/a) - b e^(-s/b))/(a - b), written so that nothing cancels as b approaches a:
  // e^(-s/a) (1 + b (1 - e^(-s d))/(a - b)), d = 1/b - 1/a = (a - b)/(a b).
  const double x = s * (a - b) / (a * b);
  const double share = x > 1e-8 ? -std::expm1(-x) / x : 1 - x / 2;
  return 1 - std::exp(-s / a) * (1 + s / a * share);
}

double crest_probability(double r, double eta_1, double eta_2) {
  if (!(r > 0)) return 0;
  // P(X_1 < r) - integral over x in (0, r) of the density of X_1 times P(X_2 > r - x); the product of both bells is one
  // about `centre` with variance v.
  const double a = eta_1 * eta_1, b = eta_2 * eta_2, v = a * b / (a + b), centre = r * a / (a + b);
  const double left = centre / std::sqrt(2 * v), right = (r - centre) / std::sqrt(2 * v);
  const double integral = std::exp(-r * r / (2 * (a + b))) / a *
                          (v * (std::exp(-left * left) - std::exp(-right * right)) +
                           centre * std::sqrt(std::numbers::pi * v / 2) * (std::erf(left) + std::erf(right)));
  return rayleigh_probability(r, eta_1) - integral;
}

ErrorResult manufacturing_error(const ErrorProblem& problem) {
  problem.check();
  const double p = problem.probability;
  const boost::math::normal standard;
  const double one_sided = quantile(standard, p), two_sided = quantile(standard, (1 + p) / 2);
  ErrorResult result;
  const auto add = [&](const std::string& name, const std::string& quantity, const std::vector<double>& values,
                       double exact) {
    result.readings.push_back({name, quantity, quantile_interval(values, p, problem.confidence), exact});
  };
  const std::array<ErrorSamples, 2> draws{draw_errors(problem, 0), draw_errors(problem, 1)};
  double variance = 0;
  for (int g = 0; g < 2; ++g) {
    const auto& d = draws[g];
    const std::string name = gear_names[g], of = fmt::format(" of the {}", name);
    const double eta_1 = problem.eta_1(g), eta_2 = problem.eta_2(g), scale = std::hypot(eta_1, eta_2);
    variance += scale * scale;
    add(name + "_error", "error T" + of + ", one-sided", d.error, one_sided * scale);
    add(name + "_error_magnitude", "magnitude |T|" + of, magnitudes(d.error), two_sided * scale);
    const double rayleigh = std::sqrt(-2 * std::log1p(-p));
    add(name + "_x1", "amplitude X_1" + of + ", once per turn", d.x_1, rayleigh * eta_1);
    add(name + "_x2", "amplitude X_2" + of + ", once per tooth", d.x_2, rayleigh * eta_2);
    const auto envelope = joined(d.x_1, d.x_2, [](double a, double b) { return std::sqrt(a * a + b * b); });
    add(name + "_envelope", "envelope sqrt(X_1^2 + X_2^2)" + of, envelope,
        quantile_of([&](double r) { return envelope_probability(r, eta_1, eta_2); }, p, scale));
    add(name + "_crest", "crest X_1 + X_2" + of, joined(d.x_1, d.x_2, std::plus<>()),
        quantile_of([&](double r) { return crest_probability(r, eta_1, eta_2); }, p, scale));
    if (g == 0) result.histogram = histogram_of(envelope, problem.bins, eta_1, eta_2);
  }
  const auto sum = joined(draws[0].error, draws[1].error, std::plus<>());
  add("sum", "sum T of both gears, one-sided", sum, one_sided * std::sqrt(variance));
  add("sum_magnitude", "magnitude of the sum T of both gears", magnitudes(sum), two_sided * std::sqrt(variance));
  return result;
}

const ErrorReading& ErrorResult::at(const std::string& name) const {
  const auto found =
      std::find_if(readings.begin(), readings.end(), [&](const ErrorReading& r) { return r.name == name; });
  if (found == readings.end()) throw InputError(fmt::format("there is no reading of the error called {}", name));
  return *found;
}

}  // namespace annulus::dynamics
