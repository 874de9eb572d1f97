#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace annulus::app {

/// A path of a key with an index, "errors.planet_eccentricity_um[2]", in its parts.
struct KeyPath {
  std::string key;
  std::optional<std::string> index{};  ///< as written, without brackets
};
[[nodiscard]] KeyPath split_path(const std::string& path);

/// The place in a list of that length, from 0, of an index that counts from 1. `meaning`: of the index, for messages.
/// Throws InputError, naming the path, where there is no such place.
[[nodiscard]] std::size_t parse_index(const std::string& path, const std::string& index, std::size_t length,
                                      const char* meaning = "");

}  // namespace annulus::app
