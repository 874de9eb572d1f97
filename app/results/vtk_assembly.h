#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

/// VTK XML files that put others together, for ParaView. Throws FileError on a failed write.
namespace annulus::app {

/// Parts in one frame by their names (.vtm); their files are relative to the assembly.
void write_vtm(const std::filesystem::path& file,
               const std::vector<std::pair<std::string, std::filesystem::path>>& parts);
/// A course (.pvd): files, relative to it, at times that do not fall; those of one time belong together.
void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::filesystem::path>>& steps);

}  // namespace annulus::app
