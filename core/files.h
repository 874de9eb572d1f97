#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace annulus {

/// A file that appears when it is complete, and not at all otherwise: written under another name in the same folder
/// and renamed. Any number of threads and processes may write the same file; the last one wins.
class UnfinishedFile {
 public:
  /// `ending`: of the temporary name, for writers that choose a format by it.
  explicit UnfinishedFile(std::filesystem::path file, const std::string& ending = {});
  ~UnfinishedFile();  ///< leaves nothing behind
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Where to write.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  /// Call when everything is written. Throws InputError naming the file.
  void finish();

 private:
  std::filesystem::path file_, temporary_;
};

/// Whether this is the temporary name of such a file.
[[nodiscard]] bool is_unfinished(const std::filesystem::path& file);

/// Writes `text` as a whole or not at all. Throws InputError naming the file when that is not possible.
void write_file(const std::filesystem::path& file, const std::string& text);

/// The whole file, byte by byte. Throws InputError naming the file when it cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// "123 bytes, 0a1b2c3d": size and CRC-32 of the content; nothing where there is no such file.
[[nodiscard]] std::optional<std::string> file_checksum(const std::filesystem::path& file);

/// Removes what killed processes left unfinished in `folder` and below: files of none that still runs here, untouched
/// for ten minutes (another machine may be at work in the same folder).
void remove_unfinished_files(const std::filesystem::path& folder);

}  // namespace annulus
