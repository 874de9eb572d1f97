#include "core/readable_unit.h"

#include <algorithm>
#include <cmath>

namespace annulus {

namespace {

/// Multiples of the units of one quantity, from small to large.
const std::vector<std::vector<ShownUnit>>& multiples() {
  static const std::vector<std::vector<ShownUnit>> all = {
      {{"pm", 1e12}, {"nm", 1e9}, {"µm", 1e6}, {"mm", 1e3}, {"m", 1}},
      {{"mN", 1e3}, {"N", 1}, {"kN", 1e-3}, {"MN", 1e-6}},
      {{"N/m", 1}, {"kN/m", 1e-3}, {"N/µm", 1e-6}, {"kN/µm", 1e-9}, {"MN/µm", 1e-12}},
      {{"Pa", 1}, {"kPa", 1e-3}, {"MPa", 1e-6}, {"GPa", 1e-9}},
      {{"mHz", 1e3}, {"Hz", 1}, {"kHz", 1e-3}, {"MHz", 1e-6}},
      {{"µm/s²", 1e6}, {"mm/s²", 1e3}, {"m/s²", 1}, {"km/s²", 1e-3}},
      {{"mN m", 1e3}, {"N m", 1}, {"kN m", 1e-3}, {"MN m", 1e-6}},
      {{"N m/rad", 1}, {"kN m/rad", 1e-3}, {"MN m/rad", 1e-6}},
  };
  return all;
}

}  // namespace

ShownUnit readable_unit(const ShownUnit& declared, const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  const auto named = [&](const ShownUnit& u) { return u.unit == declared.unit; };
  for (const auto& units : multiples()) {
    if (largest == 0 || std::none_of(units.begin(), units.end(), named)) continue;
    const auto found = std::find_if(units.begin(), units.end(), [&](const ShownUnit& u) {
      constexpr double above = 1000;
      return largest * u.scale < above;
    });
    return found == units.end() ? units.back() : *found;
  }
  return declared;
}

FigureSpec in_readable_unit(FigureSpec spec, const std::vector<double>& values) {
  const auto shown = readable_unit({spec.unit, spec.scale}, values);
  spec.unit = shown.unit;
  spec.scale = shown.scale;
  return spec;
}

}  // namespace annulus
