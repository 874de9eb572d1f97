#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/file_guard.h"

namespace annulus::app {

/// Whose results a folder holds.
struct FolderOwner {
  std::filesystem::path file;  ///< the scene; for the pictures of a page, the page
  std::string title;
};

/// A folder of results: one process writes there at a time, they belong to one scene, and files that annulus did not
/// write stay untouched.
///
/// `owner.txt` in it names the scene and every file that annulus wrote; a name is listed before its file appears, so
/// that a killed process leaves nothing unlisted. While a process writes, it holds a lock on this file (flock(2)),
/// which the kernel releases however the process ends. FileGuard: writing over, or removing, a file that is not listed
/// throws FileError, unless it lies in one of the `shared` folders.
class ResultFolder : FileGuard {
 public:
  /// Writes nothing yet. Takes the lock where the folder has an owner. Throws Error naming the process that holds it.
  ResultFolder(std::filesystem::path folder, const FolderOwner& owner,
               const std::vector<std::filesystem::path>& shared = {});
  ~ResultFolder() override;

  /// Throws FileError when the folder belongs to a scene in another file (unless that file is gone and had the same
  /// title: it was renamed), or holds a report that annulus did not write.
  void check() const;
  /// check(), and the folder is made, locked and given to the owner.
  void begin();

  using Which = std::function<bool(const std::string& name)>;
  /// Files written since begin(), also by forked processes, by their names relative to the folder; sorted.
  [[nodiscard]] std::vector<std::string> written(const Which& which) const;
  /// Removes what annulus wrote here before begin() and not since, and folders that become empty.
  void remove_earlier(const Which& which);

 protected:
  void before_write(const std::filesystem::path& file) override;
  void before_removal(const std::filesystem::path& file) override;

 private:
  struct Record;  ///< content of owner.txt

  [[nodiscard]] std::filesystem::path list() const;
  [[nodiscard]] std::string shown(const std::string& scene) const;
  [[nodiscard]] std::string holder() const;
  void lock(int flags);
  void append(const std::string& lines);
  void replace(const Record& record);
  /// Its name in the folder; empty for files elsewhere.
  [[nodiscard]] std::string name_of(const std::filesystem::path& file) const;
  [[nodiscard]] bool listed(const std::string& name) const;
  /// The first link among the folders in which this name lies; empty: there is none.
  [[nodiscard]] std::filesystem::path link_above(const std::string& name) const;

  std::filesystem::path folder_, root_;        ///< as given; absolute
  std::vector<std::filesystem::path> shared_;  ///< absolute
  std::string scene_, title_;                  ///< as in owner.txt
  int file_ = -1;                              ///< owner.txt, locked; -1 before
  bool begun_ = false;
  std::vector<std::string> earlier_, written_;  ///< sorted
};

/// Whether a run may give this name to a file or folder in OUT. Folders named by users (rings) must have other names.
[[nodiscard]] bool is_name_of_run(const std::string& name);

/// Whether a file of OUT is one that `annulus tradeoff` writes; the others are those of a run.
[[nodiscard]] bool is_of_tradeoff(const std::string& name);
[[nodiscard]] bool is_of_statics(const std::string& name);  ///< the same of `annulus statics`
[[nodiscard]] bool is_of_run(const std::string& name);

}  // namespace annulus::app
