#include "geometry/spacing.h"

#include <algorithm>
#include <cmath>

namespace annulus::geometry {

namespace {

/// 1 + q + ... + q^(n-1)
double geometric_sum(double ratio, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum = sum * ratio + 1;
  return sum;
}

/// Ratio in [1, largest] at which the growing function `total` reaches `wanted`, by bisection of the logarithm.
template <class Function>
double ratio_that_fills(const Function& total, double wanted, double largest) {
  double low = 0;
  double high = std::log(largest);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (total(std::exp(middle)) < wanted ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

std::vector<double> accumulated(const std::vector<double>& cells) {
  std::vector<double> fractions{0};
  for (const double cell : cells) fractions.push_back(fractions.back() + cell);
  for (double& f : fractions) f /= fractions.back();
  return fractions;
}

}  // namespace

std::vector<double> uniform_fractions(int cells) { return growing_fractions(cells, 1); }

std::vector<double> growing_fractions(int cells, double ratio) {
  std::vector<double> sizes(cells);
  for (int i = 0; i < cells; ++i) sizes[i] = std::pow(ratio, i);
  return accumulated(sizes);
}

std::vector<double> both_ends_fractions(int cells, double end_cell) {
  const int half = cells / 2;
  const double first = end_cell / cells;
  const auto total = [&](double q) {
    return first * (2 * geometric_sum(q, half) + (cells % 2 == 1 ? std::pow(q, half) : 0));
  };
  constexpr double unbounded = 1e6;
  const double ratio = cells <= 2 || end_cell >= 1 ? 1 : ratio_that_fills(total, 1, unbounded);
  std::vector<double> sizes(cells);
  for (int i = 0; i < cells; ++i) sizes[i] = std::pow(ratio, std::min(i, cells - 1 - i));
  auto fractions = accumulated(sizes);
  for (int i = 0; i <= half; ++i) fractions[cells - i] = 1 - fractions[i];  // symmetric to rounding
  return fractions;
}

double growth_ratio(double length, double first, int cells, double largest) {
  return ratio_that_fills([&](double q) { return first * geometric_sum(q, cells); }, length, largest);
}

std::vector<Eigen::Vector2d> points_at(const std::function<Eigen::Vector2d(double)>& curve,
                                       const std::vector<double>& fractions) {
  constexpr int chords = 512;
  std::vector<double> length{0};
  Eigen::Vector2d previous = curve(0);
  for (int i = 1; i <= chords; ++i) {
    const Eigen::Vector2d next = curve(static_cast<double>(i) / chords);
    length.push_back(length.back() + (next - previous).norm());
    previous = next;
  }
  std::vector<Eigen::Vector2d> points;
  std::size_t i = 1;
  for (const double fraction : fractions) {
    const double wanted = fraction * length.back();
    while (i < chords && length[i] < wanted) ++i;
    const double along = (wanted - length[i - 1]) / (length[i] - length[i - 1]);
    points.push_back(curve((static_cast<double>(i) - 1 + std::clamp(along, 0.0, 1.0)) / chords));
  }
  return points;
}

}  // namespace annulus::geometry
