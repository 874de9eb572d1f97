#include "app/run/solved_case.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "app/model/gear_system.h"
#include "app/model/reuse.h"
#include "app/model/system_run.h"
#include "app/results/user_cache.h"
#include "core/errors.h"
#include "core/files.h"

namespace annulus::app {

namespace {

/// Where a solve writes its tables; gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((std::filesystem::temp_directory_path() / "annulus_XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr)
      throw FileError("cannot make the folder " + path_ + "; check that TMPDIR is writable");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

dynamics::LumpedCase solved_case(const Scene& scene, const std::string& variant, int threads) {
  if (!scene.dynamics) throw InputError(scene.file.string() + ": has no [dynamics] table; add one for a lumped system");
  check_stage(scene);
  SystemRun run(scene);
  const auto names = run.system->variants();
  const auto found =
      variant.empty() && names.size() == 1 ? names.begin() : std::find(names.begin(), names.end(), variant);
  if (found == names.end())
    throw InputError(fmt::format("{}: {} one of its rings: {}", scene.file.string(),
                                 variant.empty() ? "choose" : "'" + variant + "' is not", fmt::join(names, ", ")));
  const TemporaryFolder folder;
  const RunOptions options =
      with_reuse({.out = folder.path(), .cache = results_cache(folder.path()), .threads = threads});
  run.plan = run.system->plan(threads);
  run.solve_meshes(options);
  const auto number = static_cast<std::size_t>(found - names.begin());
  return run.system->model(number, run.tables_of(number))->lumped();
}

}  // namespace annulus::app
