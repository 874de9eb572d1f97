#pragma once

#include <filesystem>

namespace annulus::app {

/// A picture (SVG) as PNG, several times its size in pixels. Throws InputError naming the file.
void write_png(const std::filesystem::path& svg, const std::filesystem::path& png);

}  // namespace annulus::app
