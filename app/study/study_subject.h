#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/scene/overrides.h"
#include "app/study/study_result.h"

namespace annulus::app {

struct RunOptions;

/// The lumped model of a changed scene.
struct ChangedModel {
  std::string id;  ///< of everything its answer depends on; empty when not asked for
  /// The subject's results; when `quick`, only those that need no motion, the others NaN.
  /// Throws what solving throws. Any number of threads at once.
  std::function<StudyPoint(bool quick)> answer;
};

/// What studies vary: the lumped model of a scene in one or more variants (rings), which answers changed scenes with
/// named figures. One class per kind of stage.
class StudySubject {
 public:
  virtual ~StudySubject() = default;

  [[nodiscard]] virtual const Scene& scene() const = 0;
  [[nodiscard]] virtual const RunOptions& options() const = 0;
  /// Names, of folders too; a single empty one for kinds without variants.
  [[nodiscard]] virtual std::vector<std::string> variants() const = 0;
  [[nodiscard]] virtual const std::vector<FigureSpec>& figures() const = 0;
  /// The results of the scene as it is with their errors; may be empty.
  [[nodiscard]] virtual FigureSet nominal(std::size_t variant) const = 0;

  /// Solves what a changed scene needs beyond the nominal results (stiffness tables), with all threads, into
  /// OUT/`folder`; true when there was anything. Throws what solving throws.
  virtual bool prepare(const std::vector<Override>& overrides, const std::string& where,
                       const std::string& folder) const = 0;
  /// Any number of threads at once. What `prepare` made is read back from `folder`; with an empty folder only the
  /// nominal results serve. Throws InputError, naming `where`, for a scene that is not a good one.
  [[nodiscard]] virtual ChangedModel model(const std::vector<Override>& overrides, const std::string& where,
                                           std::size_t variant, const std::string& folder, bool with_id) const = 0;

  /// The motion followed from several initial conditions; nothing for kinds that do not offer it.
  [[nodiscard]] virtual std::optional<StartSpread> starts(const std::vector<Override>& overrides,
                                                          const std::string& where, std::size_t variant,
                                                          const std::string& folder, int count, int seed) const {
    (void)overrides, (void)where, (void)variant, (void)folder, (void)count, (void)seed;
    return std::nullopt;
  }

  /// The options of a run into OUT/`folder`, its earlier tables looked for alike.
  [[nodiscard]] RunOptions options_in(const std::string& folder) const;
  /// OUT/<variant>/dynamics
  [[nodiscard]] std::filesystem::path folder(std::size_t variant) const;

 protected:
  /// The mesh of a changed scene whose table was solved into OUT/`folder`/`ring`; nothing where the table of `nominal`
  /// serves. Throws InputError where it does not and `folder` is empty.
  [[nodiscard]] std::optional<MeshResult> changed_mesh(const MeshModel& nominal, const MeshModel& changed,
                                                       double mean_mesh_force, const std::string& folder) const;
  /// `prepare` of a mesh that belongs to no ring.
  bool prepare_mesh(const MeshModel& nominal, const MeshModel& changed, double mean_mesh_force,
                    const std::string& where, const std::string& folder) const;
};

/// The answer; errors of solver and input become the failure of the point.
[[nodiscard]] StudyPoint evaluate(const ChangedModel& model, bool quick);

}  // namespace annulus::app
