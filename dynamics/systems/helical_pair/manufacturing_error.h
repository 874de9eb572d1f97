#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/statistics/statistics.h"

namespace annulus::dynamics {

/// Divisors of [LiuZhangZhangWangWang2020, eqs. (6) and (7)]: eta = deviation / divisor. The amplitude, half the
/// deviation, is then exceeded with probability 0.003: 2 sqrt(-2 ln 0.003) = 6.8171, which the paper rounds.
inline constexpr double printed_divisor = 6.8;
[[nodiscard]] double exact_divisor();

/// Tangential composite deviations of one gear [ISO1328-1], m.
struct CompositeDeviations {
  int teeth = 0;
  double total = 0;           ///< F_i', over a turn
  double tooth_to_tooth = 0;  ///< f_i', over a pitch; at most F_i'
};

/// Manufacturing error of a gear pair as random amplitudes [LiuZhangZhangWangWang2020, eqs. (2) to (9)]:
///   T = X_1 sin theta + X_2 sin (teeth theta),  X_1 = (F_i' - f_i')/2, X_2 = f_i'/2 Rayleigh, theta uniform.
/// eta_1 belongs to F_i' - f_i' and eta_2 to f_i', as in eqs. (6) and (7); table 1 of the paper swaps the labels.
struct ErrorProblem {
  std::array<CompositeDeviations, 2> gears;  ///< pinion, wheel; drawn independently
  double divisor = printed_divisor;
  int samples = 10'000;
  std::uint64_t seed = 1;
  double probability = 0.95;  ///< of the quantiles
  double confidence = usual_confidence;
  int bins = 50;  ///< of the histogram

  [[nodiscard]] double eta_1(int gear) const { return (gears[gear].total - gears[gear].tooth_to_tooth) / divisor; }
  [[nodiscard]] double eta_2(int gear) const { return gears[gear].tooth_to_tooth / divisor; }
  /// Throws InputError with name and value of the quantity.
  void check() const;
};

/// Draws of one gear, one entry per sample; m, rad.
struct ErrorSamples {
  std::vector<double> x_1, x_2, angle, error;  ///< `error`: T
};
/// Sample i depends on seed, gear and i alone: more samples do not change the first ones. `gear`: 0 pinion, 1 wheel.
[[nodiscard]] ErrorSamples draw_errors(const ErrorProblem& problem, int gear);

/// One meaning of "the error at a given probability".
struct ErrorReading {
  std::string name;      ///< pinion_envelope, ...
  std::string quantity;  ///< in words
  Interval sample;       ///< quantile of the draws and its distribution-free confidence interval, m
  double exact = 0;      ///< quantile of the law, m
};

struct ErrorHistogram {
  double width = 0;              ///< m; bin i spans i width ... (i + 1) width
  std::vector<int> count;        ///< draws
  std::vector<double> expected;  ///< expected by the law
};

struct ErrorResult {
  /// Per gear: T (one-sided), |T|, X_1, X_2, envelope sqrt(X_1^2 + X_2^2), crest X_1 + X_2; of both gears: T_1 + T_2
  /// (one-sided) and its magnitude. They differ in meaning: between 9 and 16 um for the gears of
  /// [LiuZhangZhangWangWang2020].
  std::vector<ErrorReading> readings;
  ErrorHistogram histogram;  ///< of the default reading, the pinion's envelope
  [[nodiscard]] const ErrorReading& at(const std::string& name) const;  ///< throws InputError for an unknown name
  [[nodiscard]] const ErrorReading& amplitude() const { return at("pinion_envelope"); }  ///< the default
};

/// The exact quantiles of T are those of the normal law with variance eta_1^2 + eta_2^2. Each term of T is exactly
/// normal (a Rayleigh amplitude times the sine of a uniform phase). The terms have the angle in common, so their sum is
/// not. With the deviations of [LiuZhangZhangWangWang2020] its probabilities differ from normal ones by 2e-4 at 21
/// teeth, 8e-4 at 17, 0.02 at 7 and 0.07 at one. For even numbers of teeth they differ far less. Throws InputError for
/// an unusable problem.
[[nodiscard]] ErrorResult manufacturing_error(const ErrorProblem& problem);

/// Laws for one gear: probability that the quantity stays below r. All arguments in one unit of length.
[[nodiscard]] double rayleigh_probability(double r, double eta);
/// sqrt(X_1^2 + X_2^2): halves of the squares are exponential with means eta^2, their sum hypoexponential.
[[nodiscard]] double envelope_probability(double r, double eta_1, double eta_2);
/// X_1 + X_2, the largest |T| over a turn of a gear with many teeth.
[[nodiscard]] double crest_probability(double r, double eta_1, double eta_2);

}  // namespace annulus::dynamics
