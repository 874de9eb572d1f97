#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "app/model/reuse.h"
#include "app/plan/mesh_model.h"

namespace annulus {
class ResultStore;
}

namespace annulus::app {

class ResultFolder;

/// Whether results state when and how fast they were found. Merged results of many workers leave it out: they are the
/// same whoever computed what.
enum class Times { stated, left_out };

/// Which of the workers of one study this is: where it begins in work that all of them share.
struct Worker {
  int number = 1, count = 1;
};

struct RunOptions {
  std::filesystem::path out{};     ///< folder of all results
  std::filesystem::path cache{};   ///< folder of cached results; empty: OUT/cache
  ResultFolder* folder = nullptr;  ///< `out`, begun before the run writes; null: nobody watches over it
  int threads = 1;
  std::string command{};      ///< the command line, for the report
  bool with_dynamics = true;  ///< false: meshes, transmission error and stiffness only
  Times times = Times::stated;
  // Set by the run itself (with_reuse); without them nothing is noted and everything is computed.
  std::shared_ptr<Reuse> reuse{};
  std::shared_ptr<const ResultStore> store{};
  Worker worker{};
  bool for_study = false;  ///< what is computed belongs to a changed scene
  /// Changes how a mesh is solved from what was planned (measurements); absent: as planned.
  std::function<MeshModel(const MeshModel& planned)> remodel{};
};

}  // namespace annulus::app
