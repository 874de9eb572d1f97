#pragma once

#include <cstddef>
#include <string>

/// Columns of plain text, by characters and not by bytes: "µm" and "kg m²" line up.
namespace annulus {

[[nodiscard]] std::size_t characters(const std::string& text);
/// With blanks behind it up to the width, at least one: what follows stays apart.
[[nodiscard]] std::string left_aligned(const std::string& text, std::size_t width);
/// With blanks before it up to the width.
[[nodiscard]] std::string right_aligned(const std::string& text, std::size_t width);

}  // namespace annulus
