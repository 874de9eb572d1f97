#include "core/file_set.h"

#include <fmt/format.h>

#include <system_error>

#include "core/errors.h"
#include "core/files.h"
#include "core/json.h"

namespace annulus {

namespace {

bool holds(const std::filesystem::path& file, const std::string& content) {
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  return !none && size == content.size() && read_file(file) == content;
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
    std::error_code ignored;
    if (!content) {
      std::filesystem::remove(file, ignored);
    } else if (!holds(file, *content)) {
      std::filesystem::create_directories(file.parent_path(), ignored);
      write_file(file, *content);
    }
  }
}

std::string pack_files(const FileSet& files) {
  // A line of names and sizes, then the contents one after the other.
  Json sizes = Json::object();
  for (const auto& [name, content] : files) sizes[name] = content ? Json(content->size()) : Json(nullptr);
  std::string packed = sizes.dump() + "\n";
  for (const auto& [name, content] : files) packed += content.value_or("");
  return packed;
}

FileSet unpack_files(std::string_view packed) {
  const auto line = packed.find('\n');
  FileSet files;
  try {
    const auto sizes = Json::parse(packed.substr(0, line));
    std::size_t at = line + 1;
    for (const auto& [name, size] : sizes.items()) {
      auto& content = files[name];
      if (size.is_null()) continue;
      const auto count = size.get<std::size_t>();
      if (line == std::string_view::npos || count > packed.size() - at)
        throw Error("a set of files that ends too early");
      content = packed.substr(at, count);
      at += count;
    }
  } catch (const Json::exception& error) {
    throw Error(fmt::format("no set of files: {}", error.what()));
  }
  return files;
}

}  // namespace annulus
