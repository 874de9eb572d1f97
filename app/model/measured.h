#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/figure.h"

namespace annulus::app {

/// A number with its absolute error, of one variant; where inputs are not known with its spread.
struct Measured {
  std::string variant;
  double value = 0, error = 0;
  std::optional<Spread> spread{};

  /// What to expect: the median where there is a spread.
  [[nodiscard]] double likely() const { return spread ? spread->median : value; }
};

/// A quantity over several variants, of one scene or of several, by the names references use.
struct VariantQuantity {
  std::string key;   ///< "load_sharing"
  std::string name;  ///< for people: "Load sharing of the sun meshes, averaged over a mesh cycle"
  std::vector<Measured> variants{};
  int digits = 4;
};

/// Whether two numbers differ by rounding alone.
[[nodiscard]] bool same(const Measured& a, const Measured& b);
/// Whether two numbers differ by more than their error bars together; never where an error is not known.
[[nodiscard]] bool told_apart(const Measured& a, const Measured& b);

/// "'a' 1.2 and 'b' 1.3", in so many digits.
[[nodiscard]] std::string both_text(const Measured& a, const Measured& b, int digits);
/// Why two numbers cannot be distinguished.
[[nodiscard]] std::string undecided_text(const Measured& a, const Measured& b, int digits);
/// A sentence without its full stop: by how much `b` differs from `a`, and whether that is more than the error bars
/// together.
[[nodiscard]] std::string difference_text(const Measured& a, const Measured& b, int digits);

}  // namespace annulus::app
