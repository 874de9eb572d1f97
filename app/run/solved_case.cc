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
#include "app/scene/overrides.h"
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

std::size_t variant_number(const GearSystem& system, const std::string& variant) {
  const auto names = system.variants();
  if (variant.empty() && names.size() == 1) return 0;
  const auto found = std::find(names.begin(), names.end(), variant);
  if (found == names.end())
    throw InputError(fmt::format("{}: {} one of its {}s: {}", system.scene().file.string(),
                                 variant.empty() ? "choose" : "'" + variant + "' is not",
                                 variant_word(system.scene().stage.kind), fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

dynamics::LumpedCase solved_case(const Scene& scene, const std::string& variant, int threads) {
  if (!scene.dynamics) throw InputError(scene.file.string() + ": has no [dynamics] table; add one for a lumped system");
  check_stage(scene);
  SystemRun run(scene);
  const auto number = variant_number(*run.system, variant);
  const TemporaryFolder folder;
  const RunOptions options =
      with_reuse({.out = folder.path(), .cache = results_cache(folder.path()), .threads = threads});
  run.plan = run.system->plan(threads);
  run.solve_meshes(options);
  return run.system->model(number, run.tables_of(number))->lumped();
}

}  // namespace annulus::app
