#include "core/file_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <system_error>
#include <vector>

#include "core/errors.h"

namespace annulus {

namespace {

struct Guards {
  std::mutex lock;
  std::vector<FileGuard*> list;
};

Guards& guards() {
  static Guards all;
  return all;
}

}  // namespace

FileGuard::FileGuard() {
  const std::lock_guard lock(guards().lock);
  guards().list.push_back(this);
}

FileGuard::~FileGuard() {
  const std::lock_guard lock(guards().lock);
  auto& list = guards().list;
  list.erase(std::find(list.begin(), list.end(), this));
}

void ask_to_write(const std::filesystem::path& file) {
  const std::lock_guard lock(guards().lock);
  for (auto* guard : guards().list) guard->before_write(file);
}

void remove_file(const std::filesystem::path& file) {
  const std::lock_guard lock(guards().lock);
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, error))) return;
  for (auto* guard : guards().list) guard->before_removal(file);
  std::filesystem::remove(file, error);
  if (error) throw InputError(fmt::format("cannot remove {}: {}", file.string(), error.message()));
}

}  // namespace annulus
