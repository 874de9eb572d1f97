#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/model/gear_system.h"
#include "app/model/study_cases.h"
#include "app/model/study_result.h"

namespace annulus::app {

/// The results of a scene's lumped model, without those for which it lacks a table. They outlive all studies.
[[nodiscard]] const std::vector<FigureSpec>& study_figures(const Scene& scene);

/// What studies vary: the lumped models of a scene in one or more variants (rings), on the tables of the nominal run
/// where these serve and on others where not.
class StudySubject {
 public:
  /// `nominal`: a run whose meshes are solved. Both are referred to.
  StudySubject(const SystemRun& nominal, const RunOptions& options);

  [[nodiscard]] const Scene& scene() const;
  [[nodiscard]] const RunOptions& options() const { return options_; }
  /// Names, of folders too; a single empty one for kinds without variants.
  [[nodiscard]] const std::vector<std::string>& variants() const { return variants_; }
  [[nodiscard]] const std::vector<FigureSpec>& figures() const { return figures_; }
  /// The results of the scene as it is with their errors; empty without [dynamics].
  [[nodiscard]] FigureSet nominal(std::size_t variant) const;

  /// Whether tables are solved with elements, which take all threads and much memory, and not by formulas alone.
  [[nodiscard]] bool solves_elements() const;
  /// Solves what a changed scene needs beyond the nominal results (stiffness tables), with all threads, into its folder
  /// below OUT; true when there was anything. Throws what solving throws. Any number of threads at once.
  bool prepare(const StudyCase& changed) const;
  /// Any number of threads at once. Tables are those that `prepare` made for its folder; with an empty folder only the
  /// nominal results serve. The model refers to them. Throws InputError, naming the case, for a scene that is not a
  /// good one.
  [[nodiscard]] std::unique_ptr<LumpedModel> model(const StudyCase& changed, std::size_t variant) const;

  /// The results `nominal` of the scene's own model with the errors that its tables bring. `evaluate` finds them from a
  /// model on other tables.
  [[nodiscard]] FigureSet with_errors(std::size_t variant, const FigureSet& nominal,
                                      const std::function<FigureSet(const LumpedModel&)>& evaluate) const;

  /// OUT/<variant>/dynamics, which exists afterwards.
  [[nodiscard]] std::filesystem::path folder(std::size_t variant) const;

 private:
  using Place = std::pair<std::string, std::size_t>;  ///< folder, mesh

  const SystemRun& nominal_;
  const RunOptions& options_;
  std::vector<std::string> variants_;
  const std::vector<FigureSpec>& figures_;
  const std::vector<MeshResult>& tables_;
  mutable std::mutex lock_;
  mutable std::map<Place, MeshResult> prepared_;
};

}  // namespace annulus::app
