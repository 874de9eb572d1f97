#include "app/results/cached_files.h"

#include "core/file_set.h"
#include "core/result_store.h"

namespace annulus::app {

bool restore_files(const ResultStore* store, const std::string& kind, const std::string& id,
                   const std::filesystem::path& folder) {
  if (store == nullptr) return false;
  const auto packed = store->find(kind, id);
  if (!packed) return false;
  write_files(unpack_files(*packed), folder);
  return true;
}

void cache_files(const ResultStore* store, const std::string& kind, const std::string& id,
                 const std::filesystem::path& folder, const std::vector<std::string>& names) {
  if (store != nullptr) store->keep(kind, id, pack_files(read_files(folder, names)));
}

}  // namespace annulus::app
