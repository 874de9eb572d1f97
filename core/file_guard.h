#pragma once

#include <filesystem>

namespace annulus {

/// Watches over the files of a folder while it lives: whoever writes or removes a file asks first. Any number at once.
class FileGuard {
 public:
  FileGuard();
  virtual ~FileGuard();
  FileGuard(const FileGuard&) = delete;
  FileGuard& operator=(const FileGuard&) = delete;

 protected:
  friend void ask_to_write(const std::filesystem::path& file);
  friend void remove_file(const std::filesystem::path& file);

  /// Before `file` appears or is replaced. From any thread, one at a time. Throws InputError to prevent it.
  virtual void before_write(const std::filesystem::path& file) = 0;
  /// Before `file`, which exists, is removed. Throws InputError to prevent it.
  virtual void before_removal(const std::filesystem::path& file) = 0;
};

/// Asks all guards. Throws InputError of the one that refuses.
void ask_to_write(const std::filesystem::path& file);

/// Removes the file, if there is one, when no guard refuses. Throws InputError naming it when that is not possible.
void remove_file(const std::filesystem::path& file);

}  // namespace annulus
