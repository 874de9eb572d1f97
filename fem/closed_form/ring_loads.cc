#include "fem/closed_form/ring_loads.h"

#include <algorithm>
#include <cmath>

#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

/// Half the cosine transform of the spread's density: 1/2 for m = 0.
double half_transform(int m, double half_angle, Spread spread) {
  const double q = m * half_angle;
  if (spread == Spread::uniform) return std::abs(q) < 1e-4 ? 0.5 - q * q / 12 : std::sin(q) / (2 * q);
  if (std::abs(q) < 0.02) return 0.5 - q * q / 20 + q * q * q * q / 560;  // the closed form cancels like 1e-16 / q^3
  return 1.5 * (std::sin(q) - q * std::cos(q)) / (q * q * q);
}

/// Harmonic 0 has twice the norm of the others.
RingHarmonics on_circle(Circle circle, bool odd, int harmonics, const std::function<Eigen::Vector2d(int)>& pair) {
  RingHarmonics load{circle, odd, {}};
  load.terms.reserve(harmonics + 1);
  for (int n = 0; n <= harmonics; ++n) load.terms.emplace_back(pair(n) / (n == 0 ? 2 * M_PI : M_PI));
  return load;
}

/// Sines and cosines of multiples are found by recurrence, restarted so that round-off does not grow.
constexpr std::size_t restart = 64;

/// Cosines of the multiples first, first + 1, ... of every angle (a column each), and below them the sines.
void set_multiples(const std::vector<double>& angles, std::size_t first, std::size_t count, Eigen::MatrixXd& table) {
  table.resize(static_cast<Eigen::Index>(2 * count), static_cast<Eigen::Index>(angles.size()));
  for (std::size_t j = 0; j < angles.size(); ++j) {
    const double step_c = std::cos(angles[j]), step_s = std::sin(angles[j]);
    double c = 0, s = 0;
    for (std::size_t n = 0; n < count; ++n) {
      if (n % restart == 0) {
        c = std::cos(static_cast<double>(first + n) * angles[j]);
        s = std::sin(static_cast<double>(first + n) * angles[j]);
      }
      table(n, j) = c;
      table(count + n, j) = s;
      const double next = c * step_c - s * step_s;
      s = s * step_c + c * step_s;
      c = next;
    }
  }
}

}  // namespace

RingHarmonics radial_force(Circle circle, double half_angle, Spread spread, int harmonics) {
  return on_circle(circle, false, harmonics, [&](int n) -> Eigen::Vector2d {
    const double below = half_transform(n - 1, half_angle, spread), above = half_transform(n + 1, half_angle, spread);
    return {below + above, above - below};
  });
}

RingHarmonics tangential_force(Circle circle, double half_angle, Spread spread, int harmonics) {
  return on_circle(circle, true, harmonics, [&](int n) -> Eigen::Vector2d {
    const double below = half_transform(n - 1, half_angle, spread), above = half_transform(n + 1, half_angle, spread);
    return {below - above, -below - above};
  });
}

RingHarmonics moment(Circle circle, double radius, double half_angle, int harmonics) {
  // Normal traction -c sin(phi) along the middle radius, per radian.
  const double c = 1 / (radius * (half_angle - std::sin(2 * half_angle) / 2));
  return on_circle(circle, true, harmonics, [&](int n) -> Eigen::Vector2d {
    const auto s = [&](int m) { return 2 * half_angle * half_transform(m, half_angle, Spread::uniform); };
    return Eigen::Vector2d(s(n + 2) - s(n - 2), s(n + 2) + s(n - 2) - 2 * s(n)) * (c / 2);
  });
}

double centroid_radius(double radius, double half_angle, Spread spread) {
  return radius * 2 * half_transform(1, half_angle, spread);
}

RingSeries::RingSeries(const Compliance& compliance, int harmonics) {
  compliance_.reserve(harmonics + 1);
  for (int n = 0; n <= harmonics; ++n) compliance_.push_back(compliance(n) * (n == 0 ? 2 * M_PI : M_PI));
}

HarmonicCoupling RingSeries::coupling(const RingHarmonics& load, const RingHarmonics& source) const {
  HarmonicCoupling result;
  // Products of unlike parity vary with the sine of the distance.
  result.sine_ = load.odd != source.odd;
  const double sign = result.sine_ && load.odd ? -1 : 1;
  const int row = load.circle == Circle::inner ? 0 : 2, column = source.circle == Circle::inner ? 0 : 2;
  const std::size_t count = std::min({load.terms.size(), source.terms.size(), compliance_.size()});
  result.terms_.reserve(count);
  double largest = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const Eigen::Vector2d displacement = compliance_[n].block<2, 2>(row, column) * source.terms[n];
    result.terms_.push_back(sign * load.terms[n].dot(displacement));
    largest = std::max(largest, std::abs(result.terms_.back()));
  }
  while (!result.terms_.empty() && std::abs(result.terms_.back()) < 1e-18 * largest) result.terms_.pop_back();
  return result;
}

double HarmonicCoupling::operator()(double angle) const {
  const double step_c = std::cos(angle), step_s = std::sin(angle);
  double sum = 0;
  for (std::size_t first = 0; first < terms_.size(); first += restart) {
    double c = std::cos(static_cast<double>(first) * angle), s = std::sin(static_cast<double>(first) * angle);
    for (std::size_t n = first; n < std::min(first + restart, terms_.size()); ++n) {
      sum += terms_[n] * (sine_ ? s : c);
      const double next = c * step_c - s * step_s;
      s = s * step_c + c * step_s;
      c = next;
    }
  }
  return sum;
}

Eigen::MatrixXd HarmonicCoupling::operator()(const std::vector<double>& angles,
                                             const std::vector<double>& sources) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(angles.size(), sources.size());
  constexpr std::size_t block = 8 * restart;  // keeps the tables small
  // New memory for every block would cost more than its sines.
  Eigen::MatrixXd left, right;
  for (std::size_t first = 0; first < terms_.size(); first += block) {
    const std::size_t count = std::min(block, terms_.size() - first);
    const Eigen::Map<const Eigen::VectorXd> terms(terms_.data() + first, count);
    set_multiples(angles, first, count, left);
    set_multiples(sources, first, count, right);
    // cos n(a - b) = cos na cos nb + sin na sin nb, sin n(a - b) = sin na cos nb - cos na sin nb
    if (sine_) {
      right.topRows(count).swap(right.bottomRows(count));
      right.topRows(count) *= -1;
    }
    right.topRows(count).array().colwise() *= terms.array();
    right.bottomRows(count).array().colwise() *= terms.array();
    sum += lapack::transpose_product(left, right);
  }
  return sum;
}

}  // namespace annulus::fem
