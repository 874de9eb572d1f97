#include "app/scene/key_path.h"

#include <fmt/format.h>

#include <charconv>

#include "core/errors.h"

namespace annulus::app {

KeyPath split_path(const std::string& path) {
  const auto bracket = path.find('[');
  if (bracket == std::string::npos || !path.ends_with(']')) return {path};
  return {path.substr(0, bracket), path.substr(bracket + 1, path.size() - bracket - 2)};
}

std::size_t parse_index(const std::string& path, const std::string& index, std::size_t length, const char* meaning) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), number);
  if (error != std::errc{} || end != index.data() + index.size() || number < 1 || number > length)
    throw InputError(fmt::format("{}: [{}] must be a number from 1 to {}{}", path, index, length, meaning));
  return number - 1;
}

}  // namespace annulus::app
