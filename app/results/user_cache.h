#pragma once

#include <filesystem>

namespace annulus::app {

/// Where annulus keeps what outlives a results folder: $ANNULUS_CACHE, else $XDG_CACHE_HOME/annulus, else
/// ~/.cache/annulus. Empty, so that nothing is stored there, when ANNULUS_CACHE is set to nothing or no home is known.
[[nodiscard]] std::filesystem::path user_cache();

/// The cache of a run into `out`: user_cache()/results, else OUT/cache.
[[nodiscard]] std::filesystem::path results_cache(const std::filesystem::path& out);

}  // namespace annulus::app
