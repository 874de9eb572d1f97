#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/overrides.h"
#include "app/pipeline.h"
#include "app/study_cases.h"

namespace annulus::app {

/// The lumped model of one ring in a changed scene.
struct ChangedStage {
  dynamics::PlanetaryStage stage;
  dynamics::SimulationOptions simulation;
  std::string id;  ///< of everything the response depends on; empty when not asked for
};

/// Sun mesh first, then one per ring.
[[nodiscard]] std::vector<MeshModel> mesh_models(const Scene& scene, const GearGeometry& geometry);

/// Whether a table solved for `nominal` answers for `changed` as well: the same bodies, and a mean mesh force within
/// the tabulated loads, between which tables are interpolated.
[[nodiscard]] bool table_serves(const MeshModel& nominal, const MeshModel& changed, double mean_mesh_force);

/// Throws the error again as InputError "file: where: what" when it is one of the input; others unchanged.
[[noreturn]] void rethrow_at(const Scene& scene, const std::string& where);

/// A changed scene with the geometry it makes.
struct ChangedScene {
  Scene scene;
  GearGeometry geometry;
};
/// Throws InputError naming the study and the value where the changed scene is not a good one.
[[nodiscard]] ChangedScene change_scene(const Scene& scene, const StudyCase& study_case);

/// Makes stages of changed scenes, on the tables of the nominal run where these serve and on others where not.
class ChangedStages {
 public:
  ChangedStages(const RunResult& nominal, const RunOptions& options) : nominal_(nominal), options_(options) {}

  /// Solves the tables of a changed scene that the nominal ones do not serve, with all threads, into
  /// OUT/`folder`/<ring>; true when there were any. Throws what solving throws.
  bool prepare(const std::vector<Override>& overrides, const std::string& where, const std::string& folder) const;

  /// The stage of one ring; any number of threads at once. Tables that `prepare` made are read back from `folder`;
  /// with an empty folder only the nominal ones serve, and what they do not cover is refused.
  [[nodiscard]] ChangedStage stage(const std::vector<Override>& overrides, const std::string& where, std::size_t ring,
                                   const std::string& folder, bool with_id) const;

  [[nodiscard]] const RunResult& nominal() const { return nominal_; }
  [[nodiscard]] const RunOptions& options() const { return options_; }

 private:
  [[nodiscard]] RunOptions options_in(const std::string& folder) const;
  [[nodiscard]] const MeshResult& nominal_mesh(std::size_t mesh) const;

  const RunResult& nominal_;
  const RunOptions& options_;
};

}  // namespace annulus::app
