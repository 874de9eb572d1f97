#pragma once

#include <filesystem>

namespace annulus {

/// Holds a lock on a file (flock(2)), which is made where it is missing, and waits for whoever holds it, on other
/// machines too. The kernel releases it however the process ends. Where the disk knows no locks it warns, and holds
/// none.
class FileLock {
 public:
  /// Throws FileError where the file cannot be made.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace annulus
