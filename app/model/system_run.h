#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"
#include "app/model/study_result.h"
#include "app/plan/plan.h"
#include "app/report/section.h"
#include "app/results/figure_table.h"
#include "app/scene/reference.h"
#include "core/figure.h"
#include "core/json.h"
#include "core/log.h"

namespace annulus::app {

/// A run of a gear system, whose results grow step by step: `run_system` (run.h) takes the steps.
struct SystemRun {
  Scene scene{};
  Plan plan{};
  std::optional<Reference> reference{};                   ///< published results to compare with
  StudyResults studies{};                                 ///< sweeps, samples, sensitivity, as the scene asks
  StageTimers timers{};                                   ///< named steps of this run
  std::vector<std::pair<std::string, double>> timings{};  ///< wall seconds by step, then "other" and "total"
  double peak_memory_MB = 0;
  PlanCost cost{};  ///< predicted and actual, of the steps that were not reused
  std::shared_ptr<const Reuse> reuse{};

  virtual ~SystemRun() = default;

  /// Stiffness tables of all planned meshes.
  virtual void solve_meshes(const RunOptions& options) = 0;
  /// The lumped models on these tables. Called where the scene has [dynamics] and the options ask for it.
  virtual void respond(const RunOptions& options) = 0;

  /// The meshes of this run, each once.
  [[nodiscard]] virtual std::vector<const MeshResult*> meshes() const = 0;
  /// All results by their keys.
  [[nodiscard]] virtual std::vector<VariantFigures> variants() const = 0;
  /// The cost of a planned step; nothing for one that was reused.
  [[nodiscard]] virtual std::optional<CostRun> actual(const CostStep& step) const = 0;
  /// The stiffness of the meshes of the lumped models, in the order of GearSystem::model_meshes: what studies begin
  /// with.
  [[nodiscard]] virtual std::vector<const MeshResult*> model_tables() const = 0;

  /// Members of summary.json beyond those of every kind.
  [[nodiscard]] virtual Json summary() const = 0;
  /// The results in a few lines for the standard output.
  [[nodiscard]] virtual std::string text() const = 0;
  /// The page of report.html.
  [[nodiscard]] virtual Page report() const = 0;

 protected:
  SystemRun() = default;
  SystemRun(const SystemRun&) = default;
  SystemRun(SystemRun&&) = default;
  SystemRun& operator=(const SystemRun&) = default;
  SystemRun& operator=(SystemRun&&) = default;
};

}  // namespace annulus::app
