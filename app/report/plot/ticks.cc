#include "app/report/plot/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace annulus::app {

const char* palette(std::size_t index) {
  static constexpr const char* colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
                                            "#444444", "#882255", "#999933", "#332288", "#661100", "#88CCEE"};
  return colours[index % std::size(colours)];
}

double round_below(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  return power * (value >= 5 * power ? 5 : value >= 2 * power ? 2 : 1);
}

double significant(double value, int digits) {
  if (value == 0) return 0;
  const double scale = std::pow(10.0, digits - 1 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(scale) && scale > 0 ? std::round(value * scale) / scale : value;
}

std::vector<double> nice_ticks(double low, double high, int count) {
  if (!(high > low) || count < 1) return {low};
  // Above the step below: 2 follows 1, 5 follows 2.
  const double raw = 0.999 * (high - low) / count, below = round_below(raw);
  const double step = raw <= below ? below : round_below(2.51 * below);
  std::vector<double> ticks;
  // Multiples of the step, so that rounding does not add up; the slack admits an end that is off by an ulp.
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i)
    ticks.push_back(i == 0 ? 0.0 : i * step);
  // A step as long as the range may have no multiple in it.
  return ticks.empty() ? nice_ticks(low, high, count + 1) : ticks;
}

std::vector<double> log_ticks(double low, double high) {
  std::vector<double> ticks;
  if (!(low > 0)) return {low, high};  // nothing to show
  const bool many = high / low > 1e3;
  for (int power = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, power) <= high * (1 + 1e-9); ++power) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10.0, power);
      if ((many && factor > 1) || tick < low * (1 - 1e-9) || tick > high * (1 + 1e-9)) continue;
      ticks.push_back(tick);
    }
  }
  if (ticks.size() < 2) return {low, high};
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  std::vector<std::string> labels;
  labels.reserve(ticks.size());
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
  const double largest = std::max(std::abs(ticks.front()), std::abs(ticks.back()));
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-6)), 0, 12);
  const int digits =
      largest > 0 ? std::clamp(static_cast<int>(std::ceil(std::log10(largest / step) - 1e-6)), 0, 15) : 0;
  const bool powers = largest >= 1e6 || step < 1e-5;
  for (const double t : ticks)
    labels.push_back(!powers ? fmt::format("{:.{}f}", t, decimals) : t == 0 ? "0" : fmt::format("{:.{}e}", t, digits));
  return labels;
}

void RangeFinder::add(double value) {
  if (!std::isfinite(value)) return;
  low_ = any_ ? std::min(low_, value) : value;
  high_ = any_ ? std::max(high_, value) : value;
  any_ = true;
}

void RangeFinder::add(const std::vector<double>& values) {
  for (const double v : values) add(v);
}

Range RangeFinder::range(double margin) const {
  if (!any_) return {0, 1};
  const double span = high_ - low_;
  if (span <= 1e-12 * std::max(std::abs(low_), std::abs(high_))) {
    const double around = low_ == 0 ? 1 : 0.1 * std::abs(low_);
    return {low_ - around, high_ + around};
  }
  return {low_ - margin * span, high_ + margin * span};
}

}  // namespace annulus::app
