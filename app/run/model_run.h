#pragma once

#include <string>
#include <vector>

#include "app/model/gear_system.h"
#include "app/model/system_run.h"

namespace annulus::app {

/// The results of the lumped model of a variant with the errors that its tables bring.
[[nodiscard]] FigureSet model_results(const GearSystem& system, std::size_t variant,
                                      const std::vector<const MeshResult*>& tables);

/// A run by the lumped models of a gear system alone: stiffness tables, results with the errors of the tables carried
/// into them, and a page with the sections that all kinds have. A kind that has more to show has a SystemRun of its
/// own.
class ModelRun final : public SystemRun {
 public:
  explicit ModelRun(const Scene& of) { scene = of; }

  void solve_meshes(const RunOptions& options) override;
  void respond(const RunOptions& options) override;
  [[nodiscard]] std::vector<const MeshResult*> meshes() const override;
  [[nodiscard]] std::vector<VariantFigures> variants() const override;
  [[nodiscard]] std::optional<CostRun> actual(const CostStep& step) const override;
  [[nodiscard]] std::vector<const MeshResult*> model_tables() const override;
  [[nodiscard]] Json summary() const override;
  [[nodiscard]] std::string text() const override;
  [[nodiscard]] Page report() const override;

 private:
  std::vector<MeshResult> tables_{};    ///< in the order of GearSystem::model_meshes
  std::vector<FigureSet> responses_{};  ///< by variant; empty without [dynamics]
};

}  // namespace annulus::app
