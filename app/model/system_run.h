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
#include "app/results/figure_table.h"
#include "app/scene/reference.h"
#include "core/figure.h"
#include "core/log.h"
#include "dynamics/figures/shaft_results.h"
#include "dynamics/steady_state/other_motions.h"

namespace annulus::app {

class GearSystem;

/// The answer of a lumped model of a run. Kinds add what their summary and report show besides.
struct RunResponse {
  virtual ~RunResponse() = default;
  FigureSet figures{};  ///< results by their keys, with errors
  dynamics::FoundMotions motions{};
  std::vector<dynamics::ShaftResult> shafts{};  ///< of the rotors
  bool reused = false;
  double seconds = 0;  ///< wall; little when it was read back
};

/// A run of a gear system of any kind, whose results grow step by step: `run_system` (run/pipeline.h) takes the steps.
struct SystemRun : std::enable_shared_from_this<SystemRun> {
  explicit SystemRun(const Scene& of);
  SystemRun(const SystemRun&) = delete;
  SystemRun& operator=(const SystemRun&) = delete;
  ~SystemRun();

  Scene scene;
  std::unique_ptr<const GearSystem> system;  ///< of this scene
  Plan plan{};
  std::optional<Reference> reference{};                         ///< published results to compare with
  std::vector<MeshResult> tables{};                             ///< in the order of GearSystem::run_meshes
  std::vector<std::unique_ptr<const RunResponse>> responses{};  ///< by GearSystem::run_variants; empty without dynamics
  StudyResults studies{};                                       ///< sweeps, samples, sensitivity, as the scene asks
  StageTimers timers{};                                         ///< named steps of this run
  std::vector<std::pair<std::string, double>> timings{};        ///< wall seconds by step, then "other" and "total"
  double peak_memory_MB = 0;
  PlanCost cost{};  ///< predicted and actual, of the steps that were not reused
  std::shared_ptr<const Reuse> reuse{};
  std::string command{}, date{};  ///< for the report: the command line, and when it ran

  /// Stiffness tables of all meshes.
  void solve_meshes(const RunOptions& options);
  /// The lumped models on these tables. Called where the scene has [dynamics] and the options ask for it.
  void respond(const RunOptions& options);

  /// The meshes that were solved or read back.
  [[nodiscard]] std::vector<const MeshResult*> meshes() const;
  /// Those on which a lumped model stands.
  [[nodiscard]] std::vector<const MeshResult*> tables_of(std::size_t variant) const;
  /// All results by their keys.
  [[nodiscard]] std::vector<VariantFigures> variants() const;
  /// The cost of a planned step; nothing for one that was reused.
  [[nodiscard]] std::optional<CostRun> actual(const CostStep& step) const;
};

/// A run as the summary and the report of its kind read it. Keeps a run alive that others share.
struct RunView {
  explicit RunView(const SystemRun& of)
      : owner(of.weak_from_this().lock()),
        run(of),
        scene(of.scene),
        plan(of.plan),
        reference(of.reference),
        studies(of.studies),
        timings(of.timings),
        cost(of.cost),
        reuse(of.reuse) {}
  operator const SystemRun&() const { return run; }  // NOLINT(google-explicit-constructor): it is that run

  [[nodiscard]] std::vector<VariantFigures> variants() const { return run.variants(); }

  std::shared_ptr<const SystemRun> owner;
  const SystemRun& run;
  const Scene& scene;
  const Plan& plan;
  const std::optional<Reference>& reference;
  const StudyResults& studies;
  const std::vector<std::pair<std::string, double>>& timings;
  const PlanCost& cost;
  const std::shared_ptr<const Reuse>& reuse;
};

}  // namespace annulus::app
