#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/errors.h"

namespace annulus {

/// A file or folder that cannot be written. Exit status 2. Not an InputError: no key of a scene is to blame.
class FileError : public Error {
 public:
  using Error::Error;
};

/// "cannot write FILE: REASON; REMEDY"; `error`: errno, or 0 where it is not known.
[[nodiscard]] FileError cannot_write(const std::filesystem::path& file, int error);

/// A file that appears when it is complete, and not at all otherwise: written under another name in the same folder
/// and renamed. Any number of threads and processes may write the same file; the last one wins. A symbolic link under
/// either name is never followed. Guards (core/file_guard.h) are asked first.
class UnfinishedFile {
 public:
  /// Makes the temporary file, empty. `ending`: of its name, for writers that choose a format by it. Throws FileError.
  explicit UnfinishedFile(std::filesystem::path file, const std::string& ending = {});
  ~UnfinishedFile();  ///< leaves nothing behind
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Where to write: a file that is there.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  /// Call when everything is written. Throws FileError.
  void finish();

 private:
  std::filesystem::path file_, temporary_;
};

/// Whether this is the temporary name of such a file.
[[nodiscard]] bool is_unfinished(const std::filesystem::path& file);

/// Writes `text` as a whole or not at all. Throws FileError when that is not possible.
void write_file(const std::filesystem::path& file, const std::string& text);

/// The whole file, byte by byte. Throws InputError naming the file when it cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// "123 bytes, 0a1b2c3d": size and CRC-32 of the content; nothing where there is no such file.
[[nodiscard]] std::optional<std::string> file_checksum(const std::filesystem::path& file);
/// The same of a text.
[[nodiscard]] std::string text_checksum(std::string_view text);

/// Removes what killed processes left unfinished in `folder` and below: files of none that still runs here, untouched
/// for ten minutes (another machine may be at work in the same folder).
void remove_unfinished_files(const std::filesystem::path& folder);

}  // namespace annulus
