#include "geometry/flank_tolerances.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/errors.h"

namespace annulus::geometry {

namespace {

constexpr double mm = 1e-3, um = 1e-6, degree = std::numbers::pi / 180;

void check_range(const std::string& name, double value, double low, double high, const std::string& unit) {
  // Diameters come from products: rounding must not decide.
  constexpr double rounding = 1e-9;
  if (value >= low * (1 - rounding) && value <= high * (1 + rounding)) return;
  throw GeometryError(
      fmt::format("ISO 1328-1 has no flank tolerances for a {} of {:.6g}{}: its range is {:g} to {:g}{}", name, value,
                  unit, low, high, unit));
}

/// µm: whole ones above 10, halves from 5 to 10, tenths below.
double rounded(double tolerance) {
  if (tolerance > 10) return std::round(tolerance);
  if (tolerance >= 5) return std::round(2 * tolerance) / 2;
  return std::round(10 * tolerance) / 10;
}

void check_ranges(const ToleranceGear& gear, int flank_class) {
  check_range("flank tolerance class", flank_class, best_flank_class, worst_flank_class, "");
  check_range("number of teeth", gear.teeth, 5, 1000, "");
  check_range("reference diameter", gear.reference_diameter / mm, 5, 15000, " mm");
  check_range("normal module", gear.module / mm, 0.5, 70, " mm");
  check_range("helix angle", std::abs(gear.helix_angle) / degree, 0, 45, "°");
}

double of_class(int flank_class) { return std::pow(2.0, (flank_class - 5) / 2.0); }

/// µm, not rounded.
double cumulative_pitch(const ToleranceGear& gear, int flank_class) {
  check_ranges(gear, flank_class);
  const double d = gear.reference_diameter / mm, m = gear.module / mm;
  return (0.002 * d + 0.55 * std::sqrt(d) + 0.7 * m + 12) * of_class(flank_class);
}

}  // namespace

double cumulative_pitch_tolerance(const ToleranceGear& gear, int flank_class) {
  return rounded(cumulative_pitch(gear, flank_class)) * um;
}

double single_pitch_tolerance(const ToleranceGear& gear, int flank_class) {
  check_ranges(gear, flank_class);
  const double d = gear.reference_diameter / mm, m = gear.module / mm;
  return rounded((0.001 * d + 0.4 * m + 5) * of_class(flank_class)) * um;
}

double runout_tolerance(const ToleranceGear& gear, int flank_class) {
  return rounded(0.9 * cumulative_pitch(gear, flank_class)) * um;
}

}  // namespace annulus::geometry
