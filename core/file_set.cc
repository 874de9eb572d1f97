#include "core/file_set.h"

#include <system_error>

#include "core/file_guard.h"
#include "core/files.h"

namespace annulus {

namespace {

bool holds(const std::filesystem::path& file, const std::string& content) {
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  return !none && size == content.size() && !std::filesystem::is_symlink(file, none) && read_file(file) == content;
}

}  // namespace

FileSet read_files(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  FileSet files;
  for (const auto& name : names) {
    auto& content = files[name];
    if (std::filesystem::exists(folder / name)) content = read_file(folder / name);
  }
  return files;
}

void write_files(const FileSet& files, const std::filesystem::path& folder) {
  for (const auto& [name, content] : files) {
    const auto file = folder / name;
    if (!content) {
      remove_file(file);
    } else if (holds(file, *content)) {
      ask_to_write(file);  // it is there as if it had been written
    } else {
      std::error_code ignored;
      std::filesystem::create_directories(file.parent_path(), ignored);
      write_file(file, *content);
    }
  }
}

}  // namespace annulus
