#pragma once

#include <string>
#include <vector>

#include "core/figure.h"

namespace annulus {

/// A unit in which results are shown: the value in SI times `scale`.
struct ShownUnit {
  std::string unit;
  double scale = 1;
};

/// Quantities that have decimal multiples, each in a usual unit.
namespace shown_units {
inline const ShownUnit length{"µm", 1e6}, force{"N", 1}, torque{"N m", 1}, stiffness{"N/µm", 1e-6},
    acceleration{"m/s²", 1}, frequency{"Hz", 1};
}  // namespace shown_units

/// The decimal multiple of a unit in which the largest of `values` (SI, of either sign) is at least 1 and below 1000:
/// "kN/µm" for "N/µm". The nearest there is beyond those in use. The unit as it is, where it has no multiples (%, arc
/// seconds, none) or nothing is known but zeros.
[[nodiscard]] ShownUnit readable_unit(const ShownUnit& declared, const std::vector<double>& values);

/// The declaration with that unit.
[[nodiscard]] FigureSpec in_readable_unit(FigureSpec spec, const std::vector<double>& values);

}  // namespace annulus
