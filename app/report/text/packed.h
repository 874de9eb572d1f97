#pragma once

#include <string>

namespace annulus::app {

/// The text deflated (zlib) and in base 64: pictures and numbers of a report take a quarter of their room.
[[nodiscard]] std::string packed(const std::string& text);

}  // namespace annulus::app
