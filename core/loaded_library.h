#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace annulus {

/// A library of annulus that is loaded when it is needed first: the large libraries behind it (finite elements, meshes,
/// searches) take most of the time and memory of a program's start, and most commands need none of them.
///
/// It lies beside the core library and offers one table of functions, `annulus_NAME_table`, whose type the two sides
/// share through a header.
class LoadedLibrary {
 public:
  /// `name`: of the file libannulus_NAME.so.
  explicit constexpr LoadedLibrary(const char* name) : name_(name) {}

  [[nodiscard]] std::filesystem::path file() const;
  /// Loads the library when it is not there yet; several threads may ask at once. Throws FileError when it is missing
  /// or cannot be loaded.
  [[nodiscard]] const void* table() const;

 private:
  const char* name_;
};

/// All of them: they belong to the program's identity, loaded or not.
inline constexpr LoadedLibrary meshing_library("meshing"), elements_library("elements"),
    optimisers_library("optimisers");
[[nodiscard]] std::vector<LoadedLibrary> loaded_libraries();

}  // namespace annulus
