#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace annulus {

/// Files of a folder by their names in it ("mesh/sun_planet.svg"); nothing for one that must not be there.
using FileSet = std::map<std::string, std::optional<std::string>>;

/// Throws InputError naming a file that is there but cannot be read.
[[nodiscard]] FileSet read_files(const std::filesystem::path& folder, const std::vector<std::string>& names);
/// Makes the folder hold this set; files that are right already stay untouched. Throws InputError naming the file that
/// cannot be written.
void write_files(const FileSet& files, const std::filesystem::path& folder);

}  // namespace annulus
