#pragma once

#include <string>

namespace annulus::app {

/// `text` with &, <, > and " made harmless in XML and HTML.
[[nodiscard]] std::string escape(const std::string& text);

}  // namespace annulus::app
