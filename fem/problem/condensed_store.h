#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>

namespace annulus::fem {

class ByteReader;
class ByteWriter;

/// Condensed teeth kept in a folder, one file each, named by the hash of all they depend on: within a run and from run
/// to run none is condensed twice. Safe for threads and for programs that share the folder. Files change the time of a
/// solve, never its result.
class CondensedStore {
 public:
  /// The files of a folder are kept below `most_bytes` together: what was not used for longest is removed.
  static constexpr std::uintmax_t usual_most_bytes = 1'000'000'000;
  /// `version`: of the program; teeth of another one are not used.
  CondensedStore(std::filesystem::path folder, std::string version, std::uintmax_t most_bytes = usual_most_bytes);

  /// Name of what depends on `inputs`: a hash of them, of the version and of the format of the files.
  [[nodiscard]] std::string key(const std::string& inputs) const;
  /// Reads the file of a key, or makes the thing and writes its file. Who asks for a key that is being made waits.
  /// True when it was read. A file that is damaged, cut off or of another kind is made again; one that cannot be
  /// written is not kept.
  bool read_or_make(const std::string& key, const std::function<void(ByteReader&)>& read,
                    const std::function<void()>& make, const std::function<void(ByteWriter&)>& write);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  [[nodiscard]] std::filesystem::path file(const std::string& key) const { return folder_ / (key + ".tooth"); }
  [[nodiscard]] bool read(const std::string& key, const std::function<void(ByteReader&)>& read) const;
  void write(const std::string& key, const std::function<void(ByteWriter&)>& write) const;
  void remove_oldest(const std::filesystem::path& newest) const;

  std::filesystem::path folder_;
  std::string version_;
  std::uintmax_t most_bytes_;
  std::mutex lock_;
  std::map<std::string, std::mutex> of_key_;
};

}  // namespace annulus::fem
