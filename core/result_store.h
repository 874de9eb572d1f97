#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace annulus {

/// Results cached in a folder, one file each, named by the hash of everything they depend on. A file changes the time
/// of a run, never its result: each has a checksum, and a damaged or foreign one is reported, removed and computed
/// again. Safe for threads, and for programs that share the folder.
class ResultStore {
 public:
  static constexpr std::uintmax_t usual_most_bytes = 1'000'000'000;

  /// `program`: its identity; results of another one are never found. The files stay below `most_bytes` together:
  /// those unused for the longest time are removed. `others`: folders of results in which it looks too, and to which it
  /// adds nothing.
  ResultStore(std::filesystem::path folder, std::string program, std::uintmax_t most_bytes = usual_most_bytes,
              std::vector<std::filesystem::path> others = {});

  /// The cached content of this kind (a word, the name of a folder) that depends on `inputs` (any bytes); nothing where
  /// there is none. The own folder comes first, then the others in their order.
  [[nodiscard]] std::optional<std::string> find(const std::string& kind, std::string_view inputs) const;
  // Where several workers have a part of one result each: the own one, and those of the others.
  [[nodiscard]] std::optional<std::string> find_own(const std::string& kind, std::string_view inputs) const;
  [[nodiscard]] std::vector<std::string> find_others(const std::string& kind, std::string_view inputs) const;

  enum class Packing { compressed, plain };  ///< plain: for numbers, which do not shrink
  /// Caches the content. One that cannot be written is reported and not cached.
  void keep(const std::string& kind, std::string_view inputs, std::string_view content,
            Packing packing = Packing::compressed) const;

  /// Calls `use` with the cached content, or else caches what `make` returns. Threads that ask for the same inputs wait
  /// for each other. True when it was found.
  bool find_or_make(const std::string& kind, std::string_view inputs, Packing packing,
                    const std::function<void(const std::string& content)>& use,
                    const std::function<std::string()>& make) const;

  struct Contents {
    std::string kind;
    std::size_t results = 0;
    std::uintmax_t bytes = 0;
  };
  /// In alphabetical order of the kinds.
  [[nodiscard]] static std::vector<Contents> contents(const std::filesystem::path& folder);
  /// Removes all cached results of a folder, and nothing else.
  static void clear(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  [[nodiscard]] std::string name_of(const std::string& kind, std::string_view inputs) const;
  void note_size(std::uintmax_t bytes, const std::filesystem::path& newest) const;

  std::filesystem::path folder_;
  std::string program_;
  std::uintmax_t most_bytes_;
  std::vector<std::filesystem::path> others_;
  mutable std::mutex lock_;
  mutable std::map<std::string, std::mutex> being_made_;  ///< by file name
  mutable std::optional<std::uintmax_t> bytes_;           ///< of all files, as far as this process knows
};

}  // namespace annulus
