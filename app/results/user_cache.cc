#include "app/results/user_cache.h"

#include <cstdlib>

namespace annulus::app {

std::filesystem::path user_cache() {
  const auto variable = [](const char* name) -> std::filesystem::path {
    const char* value = std::getenv(name);
    return value ? value : "";
  };
  if (std::getenv("ANNULUS_CACHE")) return variable("ANNULUS_CACHE");
  // A relative folder is not valid by the XDG base directory specification.
  if (const auto cache = variable("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "annulus";
  if (const auto home = variable("HOME"); home.is_absolute()) return home / ".cache" / "annulus";
  return {};
}

std::filesystem::path results_cache(const std::filesystem::path& out) {
  const auto user = user_cache();
  return user.empty() ? out / "cache" : user / "results";
}

}  // namespace annulus::app
