#include "dynamics/statistics/pitch_draws.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/statistics/sampling.h"

namespace annulus::dynamics {

namespace {

struct Places {
  std::vector<double> values;

  [[nodiscard]] double range() const {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high - *low;
  }
  /// From each tooth before, the first from the last.
  [[nodiscard]] std::vector<double> steps() const {
    std::vector<double> list;
    for (std::size_t i = 0; i < values.size(); ++i)
      list.push_back(values[i] - values[(i + values.size() - 1) % values.size()]);
    return list;
  }
  [[nodiscard]] double largest_step() const {
    double largest = 0;
    for (const double step : steps()) largest = std::max(largest, std::abs(step));
    return largest;
  }
};

}  // namespace

std::vector<double> drawn_pitch_deviations(const PitchTolerances& tolerances, std::uint64_t seed,
                                           std::string_view name) {
  require(tolerances.teeth > 2 && tolerances.single > 0 && tolerances.cumulative > 0, "pitch tolerances of a gear");
  const auto teeth = static_cast<std::size_t>(tolerances.teeth);
  const CounterDraws draw(seed, name);
  const Distribution normal{.kind = Distribution::Kind::normal, .mean = 0, .deviation = 1};
  const double direction = 2 * std::numbers::pi * draw(0);
  std::vector<double> independent;
  for (std::size_t i = 0; i < teeth; ++i) independent.push_back(normal.quantile(draw(i + 1)));
  // With this share of independent deviations, scaled to the cumulative tolerance.
  const auto mixed = [&](double share) {
    Places places;
    for (std::size_t i = 0; i < teeth; ++i)
      places.values.push_back(
          (1 - share) *
              std::sin(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(teeth) + direction) +
          share * independent[i]);
    const double scale = tolerances.cumulative / places.range();
    for (double& place : places.values) place *= scale;
    return places;
  };
  const auto beyond = [&](double share) { return mixed(share).largest_step() - tolerances.single; };
  const double of_wave = beyond(0), of_draws = beyond(1);
  double share = of_wave >= 0 ? 0 : 1;
  if (of_wave < 0 && of_draws > 0) {
    std::uintmax_t evaluations = 100;
    share = boost::math::tools::toms748_solve(beyond, 0.0, 1.0, of_wave, of_draws,
                                              boost::math::tools::eps_tolerance<double>(40), evaluations)
                .first;
  }
  auto steps = mixed(share).steps();
  const double keeps = std::min(1.0, tolerances.single / mixed(share).largest_step());
  for (double& step : steps) step *= keeps;
  return steps;
}

}  // namespace annulus::dynamics
