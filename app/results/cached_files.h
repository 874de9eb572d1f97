#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace annulus {
class ResultStore;
}

/// Results that are files of the user's folder: they are cached together and put back together, so that what is read
/// from the folder afterwards is what the inputs give, whatever happened to the files meanwhile.
namespace annulus::app {

/// Makes `folder` hold the cached files of this kind of result; false when there are none. `store` may be null.
[[nodiscard]] bool restore_files(const ResultStore* store, const std::string& kind, const std::string& id,
                                 const std::filesystem::path& folder);
/// Caches the files of `folder`. `names`: all that a result of this kind may have; those missing belong to it as well.
void cache_files(const ResultStore* store, const std::string& kind, const std::string& id,
                 const std::filesystem::path& folder, const std::vector<std::string>& names);

}  // namespace annulus::app
