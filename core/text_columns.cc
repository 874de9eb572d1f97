#include "core/text_columns.h"

#include <algorithm>

namespace annulus {

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string left_aligned(const std::string& text, std::size_t width) {
  const auto length = characters(text);
  return text + std::string(length < width ? width - length : 1, ' ');
}

std::string right_aligned(const std::string& text, std::size_t width) {
  const auto length = characters(text);
  return std::string(length < width ? width - length : 0, ' ') + text;
}

}  // namespace annulus
