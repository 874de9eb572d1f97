#pragma once

#include <optional>
#include <utility>

namespace annulus {

/// The ratio a/b of whole numbers up to a million that a positive value is to 1e-9 of it, in lowest terms; nothing
/// where there is none.
[[nodiscard]] std::optional<std::pair<long, long>> whole_ratio(double value);

}  // namespace annulus
