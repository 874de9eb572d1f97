#include "core/loaded_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/errors.h"
#include "core/files.h"

namespace annulus {

std::filesystem::path LoadedLibrary::file() const {
  Dl_info here{};
  // The loader gives addresses without a type. NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast)
  const auto* inside = reinterpret_cast<const void*>(&loaded_libraries);
  require(::dladdr(inside, &here) != 0 && here.dli_fname != nullptr, "the loader knows the core library's file");
  return std::filesystem::absolute(here.dli_fname).parent_path() / fmt::format("libannulus_{}.so", name_);
}

const void* LoadedLibrary::table() const {
  const auto path = file();
  // Loaded once, whoever asks: the loader counts and locks. Never closed: functions and types of it stay in use.
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw FileError(
        fmt::format("cannot load a library of annulus: {}; install annulus again, or raise the limit of "
                    "memory (ulimit -v) where there is one",
                    ::dlerror()));
  const auto symbol = fmt::format("annulus_{}_table", name_);
  const void* table = ::dlsym(library, symbol.c_str());
  require(table != nullptr, fmt::format("{} offers {}", path.string(), symbol));
  return table;
}

std::vector<LoadedLibrary> loaded_libraries() { return {meshing_library, elements_library, optimisers_library}; }

}  // namespace annulus
